// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "frame/rolling_shutter.h"
#include "hullslam/masks/mask_source.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"
#include "mesh/surface.h"
#include "mesh/voxel_volume.h"
#include "report/object_results.h"
#include "util/task_runner.h"

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

struct MeshOptions {
  std::optional<double> voxel = {};      // m; absent: chosen from the depths of the scene
  std::optional<double> max_depth = {};  // m; absent: the largest depth of close points (ThDepth)
  size_t every = 0;                      // use every n-th frame that has a pose; 0: the keyframes
};

struct ObjectSurface {
  ObjectId id;
  std::string label;
  SurfaceMesh surface;
};

// Of the scene, and of each mapped object that has one.
struct Mesh {
  SurfaceMesh scene;
  std::vector<ObjectSurface> objects;  // by increasing id
  std::optional<Eigen::Vector3d> up;   // world frame
  double voxel = 0.0;                  // m
  double truncation = 0.0;             // m
  double max_depth = 0.0;              // m
  size_t views = 0;
};

// Makes the mesh. `go_on` gets the number of views that are done, and of all, and returns false to
// end early, with nothing as result. If the default voxels need too much memory, they are doubled.
// Throws InputError if an image cannot be read, if no frame of the sequence has a pose or a known
// depth, and if voxels of the given size need too much memory.
std::optional<Mesh> MakeMesh(const MeshInput& input, const MeshOptions& options, TaskRunner& runner,
                             const std::function<bool(size_t done, size_t all)>& go_on);

// ---- the steps, for tests

// x and y of the point at z = 1 that each raw pixel shows, CV_32FC2; (0, 0) and `is_seen` 0 (of
// CV_8UC1) where the camera sees nothing.
cv::Mat RaysOf(const PinholeCamera& camera, cv::Mat& is_seen);

// The poses of the camera while the rows (or columns) of an image were exposed whose middle one has
// the pose `cam_from_world`. Points of the world move with `velocity` in the camera frame. One pose
// for a global shutter.
std::vector<Rigid3> PosesOfRows(const SystemOptions& options, const Rigid3& cam_from_world,
                                const PointVelocity& velocity);

// The weights of a depth image, CV_32FC1 in m. Depths beyond `max_depth` (m) are not used, nor are
// those at borders of surfaces and next to unknown ones, nor surfaces that are seen at a grazing
// angle. The weight of another depth is the cosine of this angle over the variance of the depth
// (DepthErrorOptions). `rays` are those of the camera. The view has no pose and no colour yet.
DepthView MakeDepthView(const cv::Mat& depth, const SystemOptions& options, double max_depth,
                        const cv::Mat& rays, TaskRunner& runner);

}  // namespace hullslam
