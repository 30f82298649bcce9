// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/masks/mask_source.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"
#include "report/object_results.h"

namespace hullslam {

// What a mesh is made from, as the user names it. Empty paths have the defaults in brackets.
struct MeshSource {
  std::filesystem::path input;          // the output folder of a run, or a file of --save-map
  std::filesystem::path sequence = {};  // (the one that summary.json names; a map needs it)
  std::filesystem::path settings = {};  // (settings.yaml of the run; those of the map's sequence)
  std::vector<std::string> overrides = {};  // key=value
  std::filesystem::path masks = {};         // (those of the run)
  std::string masks_format = {};
};

// A finished run or a map with its sequence.
struct MeshInput {
  SystemOptions options;
  ImageSequence sequence;
  Trajectory poses;                         // of all frames with a pose; of a map only keyframes
  std::vector<double> keyframes;            // time stamps, s
  std::vector<ObjectResult> objects;        // the mapped ones
  std::unique_ptr<const MaskSource> masks;  // null: no masks
  std::optional<Eigen::Vector3d> up;        // world frame
  std::vector<std::filesystem::path> read;  // that the mesh must not be written to
  std::vector<std::string> notes;           // what is missing, for the user
};

// Throws InputError if something is missing or broken, if the map has no keyframe, and if the run
// or the map has no depth, because it is monocular.
MeshInput OpenMeshInput(const MeshSource& source);

}  // namespace hullslam
