// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/pose_manifold.h"

#include <Eigen/Core>

namespace hullslam {

PoseBlock ToBlock(const Rigid3& pose) {
  PoseBlock block;
  Eigen::Map<Eigen::Vector4d>(block.data()) = pose.rotation.coeffs();
  Eigen::Map<Eigen::Vector3d>(block.data() + 4) = pose.translation;
  return block;
}

Rigid3 FromBlock(const double* block) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(block)),
          Eigen::Map<const Eigen::Vector3d>(block + 4)};
}

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const PoseBlock moved =
      ToBlock(Retract(FromBlock(x), Eigen::Map<const Eigen::Matrix<double, 6, 1>>(delta)));
  std::copy(moved.begin(), moved.end(), x_plus_delta);
  return true;
}

bool PoseManifold::PlusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const Rigid3 motion = FromBlock(y) * Inverse(FromBlock(x));
  Eigen::Map<Eigen::Matrix<double, 6, 1>> difference(y_minus_x);
  difference << LogSo3(motion.rotation), motion.translation;
  return true;
}

bool PoseManifold::MinusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(jacobian).setIdentity();
  return true;
}

}  // namespace hullslam
