// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/rigid3.h"

#include <cmath>

namespace hullslam {
namespace {

// The integral of the rotations by t * omega over t from 0 to 1 (V in Barfoot's "State Estimation
// for Robotics", the left Jacobian of SO(3)).
Eigen::Matrix3d VelocityIntegral(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  const double square = angle * angle;
  const bool is_small = angle < 1e-4;  // the first terms of the series are exact enough
  const double first = is_small ? 0.5 - square / 24.0 : (1.0 - std::cos(angle)) / square;
  const double second =
      is_small ? 1.0 / 6.0 - square / 120.0 : (angle - std::sin(angle)) / (square * angle);
  const Eigen::Matrix3d skew = Skew(omega);
  return Eigen::Matrix3d::Identity() + first * skew + second * skew * skew;
}

}  // namespace

Eigen::Matrix<double, 3, 4> Rigid3::ToMatrix() const {
  Eigen::Matrix<double, 3, 4> matrix;
  matrix.leftCols<3>() = rotation.toRotationMatrix();
  matrix.col(3) = translation;
  return matrix;
}

Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a) {
  return {(c_from_b.rotation * b_from_a.rotation).normalized(), c_from_b * b_from_a.translation};
}

Rigid3 Inverse(const Rigid3& b_from_a) {
  const Eigen::Quaterniond a_from_b = b_from_a.rotation.conjugate();
  return {a_from_b, -(a_from_b * b_from_a.translation)};
}

Eigen::Quaterniond ExpSo3(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  // sin(angle / 2) / angle; its series near zero keeps full precision.
  const double scale = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond rotation;
  rotation.w() = std::cos(0.5 * angle);
  rotation.vec() = scale * omega;
  return rotation.normalized();
}

Eigen::Vector3d LogSo3(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d axis = sign * rotation.vec();
  const double sine = axis.norm();
  if (sine < 1e-10) {
    return 2.0 * axis;
  }
  return (2.0 * std::atan2(sine, sign * rotation.w()) / sine) * axis;
}

Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return matrix;
}

Rigid3 PartOfMotion(const Rigid3& motion, double share) {
  const Eigen::Vector3d omega = LogSo3(motion.rotation);
  // A motion with angular velocity w and linear velocity v moves the origin by V(w) v in the
  // time 1.
  const Eigen::Vector3d velocity = VelocityIntegral(omega).inverse() * motion.translation;
  return {ExpSo3(share * omega), VelocityIntegral(share * omega) * (share * velocity)};
}

Rigid3 Retract(const Rigid3& b_from_a, const Eigen::Matrix<double, 6, 1>& delta) {
  return Rigid3(ExpSo3(delta.head<3>()), delta.tail<3>()) * b_from_a;
}

Eigen::Matrix<double, 6, 6> Adjoint(const Rigid3& b_from_a) {
  const Eigen::Matrix3d rotation = b_from_a.rotation.toRotationMatrix();
  Eigen::Matrix<double, 6, 6> adjoint;
  adjoint << rotation, Eigen::Matrix3d::Zero(), Skew(b_from_a.translation) * rotation, rotation;
  return adjoint;
}

double AngularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return LogSo3(a.conjugate() * b).norm();
}

}  // namespace hullslam
