// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hullslam {

// A rigid transform of points: a Rigid3 named `b_from_a` maps x_b = rotation * x_a + translation.
// Lengths are in metres; in monocular SLAM, in units of the map.
struct Rigid3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Rigid3() = default;
  Rigid3(const Eigen::Quaterniond& rotation_in, const Eigen::Vector3d& translation_in)
      : rotation(rotation_in), translation(translation_in) {}

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }
  Eigen::Matrix<double, 3, 4> ToMatrix() const;
};

// c_from_a = c_from_b * b_from_a. The rotation of the product has unit norm.
Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a);

Rigid3 Inverse(const Rigid3& b_from_a);

// Rotation by |omega| radians around omega.
Eigen::Quaterniond ExpSo3(const Eigen::Vector3d& omega);
// The rotation vector of `rotation`, of length at most pi.
Eigen::Vector3d LogSo3(const Eigen::Quaterniond& rotation);
// The matrix of the cross product: Skew(a) * b = a x b.
Eigen::Matrix3d Skew(const Eigen::Vector3d& a);

// The part `share` of a motion with constant linear and angular velocity: 0 gives the identity, 1
// the motion itself, 2 the motion twice. The rotation must be less than pi.
Rigid3 PartOfMotion(const Rigid3& motion, double share);

// Applies a small motion on the left, after `b_from_a`: x_b is rotated by delta[0..2] (radians) and
// then moved by delta[3..5]. The derivative at zero is dx_b / ddelta = [-Skew(x_b), I].
Rigid3 Retract(const Rigid3& b_from_a, const Eigen::Matrix<double, 6, 1>& delta);

// The delta for which Retract(a_from_world, delta) is b_from_world.
inline Eigen::Matrix<double, 6, 1> Difference(const Rigid3& a_from_world,
                                              const Rigid3& b_from_world) {
  const Rigid3 b_from_a = b_from_world * Inverse(a_from_world);
  Eigen::Matrix<double, 6, 1> delta;
  delta << LogSo3(b_from_a.rotation), b_from_a.translation;
  return delta;
}

// The matrix that turns a small motion (rotation, translation) in the axes of a into the same
// motion in the axes of b: b_from_a * Retract(a_from_world, delta) is Retract(b_from_a *
// a_from_world, Adjoint(b_from_a) * delta), to first order.
Eigen::Matrix<double, 6, 6> Adjoint(const Rigid3& b_from_a);
// The covariance of such a motion in the axes of b.
inline Eigen::Matrix<double, 6, 6> InAxesOf(const Rigid3& b_from_a,
                                            const Eigen::Matrix<double, 6, 6>& covariance_in_a) {
  return Adjoint(b_from_a) * covariance_in_a * Adjoint(b_from_a).transpose();
}

// Angle between two rotations in radians, 0 to pi.
double AngularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

}  // namespace hullslam
