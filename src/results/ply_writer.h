// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>

#include "files/bytes.h"
#include "hullslam/geometry/rigid3.h"
#include "results/unit_mesh.h"

namespace hullslam {

// Makes binary little-endian PLY files whose vertices have `float x y z, uchar red green blue`, in
// the world frame. Faces are `uchar 3, int a b c`.
class PlyWriter {
 public:
  void AddPoint(const Eigen::Vector3d& position, const Colour& colour);
  // A mesh whose coordinates are multiplied by `extents` before it is moved to its pose.
  void AddMesh(const TriangleMesh& mesh, const Rigid3& world_from_mesh,
               const Eigen::Vector3d& extents, const Colour& colour);
  // The file with all points and meshes so far.
  std::string PointFile() const;  // without a list of faces
  std::string MeshFile() const;   // with the list, which may be empty

 private:
  std::string Format(const std::string& more_elements) const;

  ByteWriter vertices_;
  ByteWriter faces_;
  uint32_t vertex_count_ = 0;
  size_t face_count_ = 0;
};

}  // namespace hullslam
