// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

namespace hullslam {
namespace {

using Colour = std::array<uint8_t, 3>;

using Triangle = std::array<uint32_t, 3>;

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

// A unit sphere: rings of corners between two poles.
struct Mesh {
  std::vector<Eigen::Vector3d> corners;
  std::vector<Triangle> triangles;
};

constexpr uint32_t kRings = 9;
constexpr uint32_t kAround = 12;

std::vector<Eigen::Vector3d> SphereCorners() {
  std::vector<Eigen::Vector3d> corners = {Eigen::Vector3d::UnitZ()};
  for (uint32_t ring = 1; ring <= kRings; ++ring) {
    const double polar = std::numbers::pi * ring / (kRings + 1);
    for (uint32_t i = 0; i < kAround; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / kAround;
      corners.emplace_back(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                           std::cos(polar));
    }
  }
  corners.emplace_back(-Eigen::Vector3d::UnitZ());
  return corners;
}

Mesh MakeSphere() {
  Mesh mesh{SphereCorners(), {}};
  const auto corner = [](uint32_t ring, uint32_t i) { return 1 + ring * kAround + i % kAround; };
  const uint32_t bottom = 1 + kRings * kAround;
  for (uint32_t i = 0; i < kAround; ++i) {
    mesh.triangles.push_back({0, corner(0, i), corner(0, i + 1)});
    for (uint32_t ring = 0; ring + 1 < kRings; ++ring) {
      mesh.triangles.push_back({corner(ring, i), corner(ring + 1, i), corner(ring + 1, i + 1)});
      mesh.triangles.push_back({corner(ring, i), corner(ring + 1, i + 1), corner(ring, i + 1)});
    }
    mesh.triangles.push_back({bottom, corner(kRings - 1, i + 1), corner(kRings - 1, i)});
  }
  return mesh;
}

// A colour of full saturation. Its hue is a hash (FNV-1a) of the class.
Colour ColourOf(std::string_view label) {
  uint32_t hash = 2166136261U;
  for (const char letter : label) {
    hash = (hash ^ static_cast<uint8_t>(letter)) * 16777619U;
  }
  const double hue = 6.0 * ((hash >> 16) % 360) / 360.0;
  Colour colour{};
  for (size_t channel = 0; channel < 3; ++channel) {
    // As a function of the hue, which goes from 0 to 6, each channel is a trapezoid of width 4
    // around its own hue (0, 2 or 4).
    const double away = std::abs(std::remainder(hue - 2.0 * static_cast<double>(channel), 6.0));
    const double value = std::clamp(2.0 - away, 0.0, 1.0);
    colour[channel] = static_cast<uint8_t>(std::lround(40.0 + 200.0 * value));
  }
  return colour;
}

}  // namespace

std::string FormatMapPly(std::span<const Eigen::Vector3d> landmarks,
                         std::span<const Eigen::Vector3d> keyframes) {
  constexpr Colour kGrey = {128, 128, 128};
  constexpr Colour kOrange = {255, 128, 0};
  std::string bytes = StartPly(landmarks.size() + keyframes.size()) + "end_header\n";
  AppendPoints(bytes, landmarks, kGrey);
  AppendPoints(bytes, keyframes, kOrange);
  return bytes;
}

std::string FormatObjectsPly(std::span<const ReportedObject> objects) {
  const Mesh sphere = MakeSphere();
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
    AppendPoints(vertices, corners, ColourOf(object.label));
    for (const Triangle& triangle : sphere.triangles) {
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
