// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_writer.h"

#include <fmt/format.h>

namespace hullslam {

void PlyWriter::AddPoint(const Eigen::Vector3d& position, const Colour& colour) {
  for (const double coordinate : position) {
    vertices_.Put(static_cast<float>(coordinate));
  }
  for (const uint8_t channel : colour) {
    vertices_.Put(channel);
  }
  ++vertex_count_;
}

void PlyWriter::AddMesh(const TriangleMesh& mesh, const Rigid3& world_from_mesh,
                        const Eigen::Vector3d& extents, const Colour& colour) {
  const uint32_t first = vertex_count_;
  for (const Eigen::Vector3d& corner : mesh.corners) {
    AddPoint(world_from_mesh * corner.cwiseProduct(extents), colour);
  }
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    faces_.Put(uint8_t{3});
    for (const uint32_t corner : triangle) {
      faces_.Put(static_cast<int32_t>(first + corner));
    }
  }
  face_count_ += mesh.triangles.size();
}

std::string PlyWriter::PointFile() const { return Format(""); }

std::string PlyWriter::MeshFile() const {
  return Format(
      fmt::format("element face {}\nproperty list uchar int vertex_indices\n", face_count_));
}

std::string PlyWriter::Format(const std::string& more_elements) const {
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
             "property float x\nproperty float y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\n{}end_header\n",
             vertex_count_, more_elements) +
         vertices_.bytes() + faces_.bytes();
}

}  // namespace hullslam
