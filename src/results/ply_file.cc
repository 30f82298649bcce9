// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_file.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "results/ply_points.h"
#include "results/unit_mesh.h"

namespace hullslam {
namespace {

void AppendBits(std::string& bytes, uint32_t bits) {
  for (int shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>(bits >> shift & 0xff);
  }
}

void AppendPoints(std::string& bytes, std::span<const Eigen::Vector3d> points,
                  const Colour& colour) {
  for (const Eigen::Vector3d& point : points) {
    for (const double coordinate : point) {
      AppendBits(bytes, std::bit_cast<uint32_t>(static_cast<float>(coordinate)));
    }
    bytes.append(colour.begin(), colour.end());
  }
}

// The header up to and including the vertices.
std::string StartPly(size_t vertices) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n",
      vertices);
}

}  // namespace

std::string FormatMapPly(std::span<const Eigen::Vector3d> landmarks,
                         std::span<const Eigen::Vector3d> keyframes) {
  constexpr Colour kGrey = {128, 128, 128};
  std::string bytes = StartPly(landmarks.size() + keyframes.size()) + "end_header\n";
  AppendPoints(bytes, landmarks, kGrey);
  AppendPoints(bytes, keyframes, kKeyframeColour);
  return bytes;
}

std::string FormatObjectsPly(std::span<const ReportedObject> objects) {
  const TriangleMesh sphere = UnitSphere();
  std::string vertices;
  std::string faces;
  uint32_t first = 0;  // first vertex of the object
  size_t count = 0;
  for (const ReportedObject& object : objects) {
    if (object.state != ObjectState::kMapped) {
      continue;
    }
    std::vector<Eigen::Vector3d> corners;
    for (const Eigen::Vector3d& corner : sphere.corners) {
      corners.push_back(object.ellipsoid.world_from_object *
                        corner.cwiseProduct(object.ellipsoid.half_axes));
    }
    AppendPoints(vertices, corners, ColourOfClass(object.label));
    for (const TriangleMesh::Triangle& triangle : sphere.triangles) {
      faces += '\x03';
      for (const uint32_t corner : triangle) {
        AppendBits(faces, first + corner);
      }
    }
    first += static_cast<uint32_t>(corners.size());
    ++count;
  }
  return StartPly(first) +
         fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                     count * sphere.triangles.size()) +
         vertices + faces;
}

}  // namespace hullslam
