// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hullslam/geometry/conic.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/geometry/sim3.h"

namespace hullslam {

// The ellipsoid of a mapped object. The centre is the origin of the object's frame, and the half
// axes lie along the axes of this frame.
struct Ellipsoid {
  Rigid3 world_from_object;
  Eigen::Vector3d half_axes = Eigen::Vector3d::Ones();  // m, each > 0

  // Q* = Z diag(a^2, b^2, c^2, -1) Z^T with Z = world_from_object. Tangent planes pi satisfy pi^T
  // Q* pi = 0.
  Eigen::Matrix4d DualQuadric() const;
  // Distance of a world point from the surface, measured along the ray to the centre, m. Negative
  // inside.
  double RadialDistance(const Eigen::Vector3d& point_in_world) const;
};

Ellipsoid operator*(const Rigid3& b_from_world, const Ellipsoid& ellipsoid);
Ellipsoid operator*(const Sim3& b_from_world, const Ellipsoid& ellipsoid);

// The projected ellipse in an undistorted image of a camera with intrinsics `k` (upper triangular,
// px): C* = P Q* P^T with P = k [R|t]. Returns nothing unless the whole ellipsoid is in front of
// the camera.
std::optional<Ellipse> ProjectEllipsoid(const Eigen::Matrix3d& k, const Rigid3& cam_from_world,
                                        const Ellipsoid& ellipsoid);

}  // namespace hullslam
