// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hullslam/geometry/conic.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// An ellipsoid as an object is mapped: its centre is the origin and its half axes lie along the
// axes of the object's frame.
struct Ellipsoid {
  Rigid3 world_from_object;
  Eigen::Vector3d half_axes = Eigen::Vector3d::Ones();  // m, each > 0

  // Q* = Z diag(a^2, b^2, c^2, -1) Z^T, Z = world_from_object: pi^T Q* pi = 0 for tangent planes
  // pi.
  Eigen::Matrix4d DualQuadric() const;
  // Distance of a world point from the surface along the ray to the centre, m; negative inside.
  double RadialDistance(const Eigen::Vector3d& point_in_world) const;
};

Ellipsoid operator*(const Rigid3& b_from_world, const Ellipsoid& ellipsoid);

// Its outline in an undistorted image of a camera with intrinsics `k` (upper triangular, px):
// C* = P Q* P^T with P = k [R|t]. Nothing unless the whole ellipsoid is in front of the camera.
std::optional<Ellipse> ProjectEllipsoid(const Eigen::Matrix3d& k, const Rigid3& cam_from_world,
                                        const Ellipsoid& ellipsoid);

}  // namespace hullslam
