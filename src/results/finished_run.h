// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "hullslam/geometry/alignment.h"
#include "hullslam/geometry/trajectory.h"
#include "report/object_results.h"
#include "results/ply_file.h"
#include "scene/scene.h"

namespace hullslam {

// The sequence that a run has read. OpenRunSequence() (datasets/run_sequence.h) opens it again.
struct SequenceOfRun {
  std::string path;          // as the user gave it; empty if the run does not say it
  std::string dataset;       // ImageSequence::dataset, such as "tum"; empty if it is not known
  std::string program = {};  // that has read it, such as "rgbd_tum"; empty if it is not known
  std::map<std::string, std::string> choices = {};  // ImageSequence::choices
};

// A finished run: what its summary.json says, and its other files, which are read when they are
// asked for. Each function that reads a file throws InputError if the file is broken.
struct FinishedRun {
  std::filesystem::path folder;
  std::shared_ptr<const nlohmann::json> summary;  // the content of summary.json; not null
  std::string program;                            // empty if it is not known
  std::string version;
  AlignmentKind alignment = AlignmentKind::kSe3;
  SequenceOfRun sequence;
  // Paths as the user gave them; empty if the run had none.
  std::string masks;
  std::string map;  // of --save-map
  std::string masks_format;
  size_t keyframes = 0;  // of the map at the end
  size_t landmarks = 0;

  // The unit of length of a monocular run is not the metre.
  bool IsMetric() const { return alignment != AlignmentKind::kSim3; }
  // Whether the run has written this file.
  bool Has(const std::string& name) const;
  // Finds what the run has read or written elsewhere: its sequence, masks or map. A relative path
  // is looked for in the working directory, then in the folder of the run and in all folders above
  // it. Absent if it is not found there, or if `path` is empty.
  std::optional<std::filesystem::path> Find(const std::string& path) const;

  // The poses of the camera whose images OpenRunSequence() gives. Those in the files are of the
  // camera as read, if the run has rectified the images.
  Trajectory ReadPoses() const;          // of all tracked frames
  Trajectory ReadPosesAsRead() const;    // the same as they are in the file
  Trajectory ReadKeyframePoses() const;  // of all sessions
  // The landmarks of map.ply. Absent, like the others, if the run has no such file.
  std::optional<PlyPoints> ReadLandmarkPoints() const;
  // The surface that `hullslam mesh` has made of the run: mesh.ply.
  std::optional<PlySurface> ReadSurface() const;
  std::optional<ObjectResults> ReadObjectResults() const;
  std::optional<Scene> ReadSceneGraph() const;
  // The ground truth that the run has converted, so that it has the stamps and axes of its poses.
  std::optional<Trajectory> ReadConvertedGroundtruth() const;
};

// Throws InputError if the folder has no summary.json, or if this is not the summary of a run.
FinishedRun OpenFinishedRun(const std::filesystem::path& folder);

}  // namespace hullslam
