// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace hullslam::synthetic {

enum class ShapeKind { kBox, kEllipsoid, kSuperquadric, kCylinder, kTorus, kRevolved };

// A primitive solid, centred at the origin of its own frame. Lengths are in metres.
struct Shape {
  ShapeKind kind = ShapeKind::kBox;
  Eigen::Vector3d half = Eigen::Vector3d::Ones();  // half extents along the axes, tight
  // Exponents of a superquadric (Barr 1981): `north` along z, `east` around z. 1 and 1 give an
  // ellipsoid, values towards 0 a box.
  double north = 1.0;
  double east = 1.0;
  double tube = 0.0;  // radius of the tube of a torus
  // Half of the section of a solid of revolution, as points (distance from the z axis, z): from the
  // z axis along the underside to the outside, and over the top back to the z axis. The solid is to
  // the left.
  std::vector<Eigen::Vector2d> profile = {};

  static Shape Box(const Eigen::Vector3d& half);
  static Shape Ellipsoid(const Eigen::Vector3d& half);
  static Shape Superquadric(const Eigen::Vector3d& half, double north, double east);
  // A cylinder along z, with flat ends.
  static Shape Cylinder(double radius, double half_height);
  // A torus around the y axis. `ring` is the radius of the circle in the middle of the tube.
  static Shape Torus(double ring, double tube);

  // A solid of revolution around z, such as a bowl, whose profile is given at any height; the frame
  // of the shape is at the middle of the height. Throws CheckError unless the profile has at least
  // three points, begins and ends at the z axis, and stays on one side of it.
  static Shape Revolved(std::vector<Eigen::Vector2d> profile);

  // Outward unit normal at a point on (or near) the surface.
  Eigen::Vector3d Normal(const Eigen::Vector3d& point) const;
};

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
};

// The surface as triangles with all vertices on it. Between the vertices the triangles of an
// ellipsoid are at most 4e-5 m inside the surface, which is 0.04 px at half a metre.
TriangleMesh Tessellate(const Shape& shape);

}  // namespace hullslam::synthetic
