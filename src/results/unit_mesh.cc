// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/unit_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "util/hash.h"

namespace hullslam {
namespace {

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

}  // namespace

TriangleMesh UnitSphere() {
  TriangleMesh mesh{SphereCorners(), {}};
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

TriangleMesh UnitCube() {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 8; ++i) {
    mesh.corners.emplace_back((i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0,
                              (i & 4U) != 0 ? 1.0 : -1.0);
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Colour ColourOfClass(std::string_view label) {
  const double hue = 6.0 * ((Fnv1a<uint32_t>(label) >> 16) % 360) / 360.0;
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

}  // namespace hullslam
