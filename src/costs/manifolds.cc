// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/manifolds.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

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

namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

}  // namespace

SimilarityBlock ToBlock(const Sim3& similarity) {
  SimilarityBlock block;
  Eigen::Map<Eigen::Vector4d>(block.data()) = similarity.rotation.coeffs();
  Eigen::Map<Eigen::Vector3d>(block.data() + 4) = similarity.translation;
  block[7] = similarity.scale;
  return block;
}

Sim3 SimilarityFromBlock(const double* block) {
  return {block[7], Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(block)),
          Eigen::Map<const Eigen::Vector3d>(block + 4)};
}

bool SimilarityManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  Vector7d step = Vector7d::Zero();
  std::copy(delta, delta + tangent_size_, step.data());
  const SimilarityBlock moved = ToBlock(Retract(SimilarityFromBlock(x), step));
  std::copy(moved.begin(), moved.end(), x_plus_delta);
  return true;
}

bool SimilarityManifold::PlusJacobian(const double*, double* jacobian) const {
  Eigen::Map<RowMajorMatrix>(jacobian, 8, tangent_size_).setIdentity();
  return true;
}

bool SimilarityManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const Sim3 motion = SimilarityFromBlock(y) * Inverse(SimilarityFromBlock(x));
  Vector7d difference;
  difference << LogSo3(motion.rotation), motion.translation, std::log(motion.scale);
  std::copy(difference.data(), difference.data() + tangent_size_, y_minus_x);
  return true;
}

bool SimilarityManifold::MinusJacobian(const double*, double* jacobian) const {
  Eigen::Map<RowMajorMatrix>(jacobian, tangent_size_, 8).setIdentity();
  return true;
}

}  // namespace hullslam
