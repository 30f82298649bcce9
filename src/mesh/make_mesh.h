// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/map/map.h"
#include "mesh/mesh_input.h"
#include "mesh/surface.h"
#include "util/task_runner.h"

namespace hullslam {

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

}  // namespace hullslam
