// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace hullslam {

// A closed surface of triangles. Their corners are in anticlockwise order seen from outside.
struct TriangleMesh {
  using Triangle = std::array<uint32_t, 3>;  // indices into `corners`
  std::vector<Eigen::Vector3d> corners;
  std::vector<Triangle> triangles;
};

// A sphere of radius 1 around the origin, with 216 triangles: rings of corners between two poles.
TriangleMesh UnitSphere();
// The cube from -1 to 1 in all three coordinates.
TriangleMesh UnitCube();

using Colour = std::array<uint8_t, 3>;  // red, green, blue

// A colour of full saturation for the objects of a class. Its hue is a hash (FNV-1a) of the name,
// so a class has the same colour in every run.
Colour ColourOfClass(std::string_view label);

}  // namespace hullslam
