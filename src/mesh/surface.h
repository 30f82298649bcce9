// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "mesh/voxel_volume.h"
#include "results/unit_mesh.h"
#include "util/task_runner.h"

namespace hullslam {

// A surface of triangles, whose corners are in anticlockwise order seen from its front.
struct SurfaceMesh {
  std::vector<Eigen::Vector3f> positions;  // m, world frame
  std::vector<Colour> colours;             // sRGB, one per position
  std::vector<TriangleMesh::Triangle> triangles;
};

// The surface where the distances of a volume are zero, by surface nets (Gibson 1998): a cube of
// eight voxels has one vertex, the mean of the points of its edges between seen voxels where the
// interpolated distance is zero, if there are three or more. Each such edge joins the vertices of
// its four cubes to two triangles. An edge whose distances differ by the truncation or more has no
// surface: its voxels were seen from different sides of something thin, or of the border of a
// surface. The same volume gives the same bits on any number of threads.
SurfaceMesh ExtractSurface(const VoxelVolume& volume, TaskRunner& runner);

// Removes parts, connected by triangles, with fewer triangles than `least`, and vertices without a
// triangle. Most small parts are made from wrong depths.
SurfaceMesh WithoutSmallParts(const SurfaceMesh& surface, size_t least);

}  // namespace hullslam
