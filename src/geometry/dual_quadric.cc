// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/dual_quadric.h"

#include <cmath>

namespace hullslam {
namespace {

// R diag(a^2, b^2, c^2) R^T: n^T * this * n is the squared half extent along a unit direction n.
Eigen::Matrix3d ShapeMatrix(const Ellipsoid& ellipsoid) {
  const Eigen::Matrix3d axes =
      ellipsoid.world_from_object.rotation.toRotationMatrix() * ellipsoid.half_axes.asDiagonal();
  return axes * axes.transpose();
}

}  // namespace

Eigen::Matrix4d Ellipsoid::DualQuadric() const {
  const Eigen::Vector3d& center = world_from_object.translation;
  Eigen::Matrix4d dual;
  dual << ShapeMatrix(*this) - center * center.transpose(), -center, -center.transpose(), -1.0;
  return dual;
}

double Ellipsoid::RadialDistance(const Eigen::Vector3d& point_in_world) const {
  const Eigen::Vector3d point = Inverse(world_from_object) * point_in_world;
  const double distance = point.norm();
  const double in_radii = point.cwiseQuotient(half_axes).norm();
  // At the centre itself the direction of the ray is undefined: the ray to the nearest end of an
  // axis is used.
  return in_radii > 0.0 ? distance - distance / in_radii : -half_axes.minCoeff();
}

Ellipsoid operator*(const Rigid3& b_from_world, const Ellipsoid& ellipsoid) {
  return {b_from_world * ellipsoid.world_from_object, ellipsoid.half_axes};
}

Ellipsoid operator*(const Sim3& b_from_world, const Ellipsoid& ellipsoid) {
  const Sim3 b_from_object = b_from_world * Sim3(ellipsoid.world_from_object);
  return {{b_from_object.rotation, b_from_object.translation},
          b_from_world.scale * ellipsoid.half_axes};
}

std::optional<Ellipse> ProjectEllipsoid(const Eigen::Matrix3d& k, const Rigid3& cam_from_world,
                                        const Ellipsoid& ellipsoid) {
  const Ellipsoid in_cam = cam_from_world * ellipsoid;
  const Eigen::Vector3d& center = in_cam.world_from_object.translation;
  const Eigen::Matrix3d shape = ShapeMatrix(in_cam);
  const double nearest_depth = center.z() - std::sqrt(shape(2, 2));
  // C*33 < 0 is not sufficient: it also holds for an ellipsoid that is wholly behind the camera.
  if (!(nearest_depth > 0.0)) {
    return std::nullopt;
  }
  return EllipseFromDualConic(k * (shape - center * center.transpose()) * k.transpose());
}

}  // namespace hullslam
