// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/relative_similarity.h"

#include <cmath>

#include "costs/manifolds.h"

namespace hullslam {
namespace {

using Matrix7d = Eigen::Matrix<double, 7, 7>;

// Derivative of Log(Exp(w) Exp(omega)) by w at 0: the inverse of the left Jacobian of SO(3)
// (Barfoot, "State Estimation for Robotics", section 7.1.5). For Log(Exp(omega) Exp(w)) it is the
// same of -omega.
Eigen::Matrix3d InverseLeftJacobian(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  const double square = angle * angle;
  // 1 / angle^2 - cot(angle / 2) / (2 angle); the series keeps full precision near zero.
  const double factor = angle < 1e-2 ? 1.0 / 12.0 + square / 720.0
                                     : 1.0 / square - 0.5 / (angle * std::tan(0.5 * angle));
  const Eigen::Matrix3d skew = Skew(omega);
  return Eigen::Matrix3d::Identity() - 0.5 * skew + factor * skew * skew;
}

void Write(const Eigen::Matrix<double, 7, 1>& inverse_sigma, const Matrix7d& derivative,
           double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, 7, 8, Eigen::RowMajor>> all(jacobian);
  all.leftCols<7>() = inverse_sigma.asDiagonal() * derivative;
  all.col(7).setZero();
}

}  // namespace

bool RelativeSimilarityCost::Evaluate(double const* const* parameters, double* residuals,
                                      double** jacobians) const {
  const Sim3 a_from_b =
      SimilarityFromBlock(parameters[0]) * Inverse(SimilarityFromBlock(parameters[1]));
  const Sim3 error = measured_b_from_a_ * a_from_b;
  const Eigen::Vector3d omega = LogSo3(error.rotation);
  Eigen::Map<Eigen::Matrix<double, 7, 1>> all(residuals);
  all << omega, error.translation, std::log(error.scale);
  all.array() *= inverse_sigma_.array();
  if (jacobians == nullptr) {
    return true;
  }
  if (jacobians[0] != nullptr) {
    const Eigen::Matrix3d rotation = measured_b_from_a_.rotation.toRotationMatrix();
    const Eigen::Matrix3d scaled = measured_b_from_a_.scale * rotation;
    Matrix7d by_a = Matrix7d::Zero();
    by_a.block<3, 3>(0, 0) = InverseLeftJacobian(omega) * rotation;
    by_a.block<3, 3>(3, 0) = -scaled * Skew(a_from_b.translation);
    by_a.block<3, 3>(3, 3) = scaled;
    by_a.block<3, 1>(3, 6) = scaled * a_from_b.translation;
    by_a(6, 6) = 1.0;
    Write(inverse_sigma_, by_a, jacobians[0]);
  }
  if (jacobians[1] != nullptr) {
    Matrix7d by_b = Matrix7d::Zero();
    by_b.block<3, 3>(0, 0) = -InverseLeftJacobian(-omega);
    by_b.block<3, 3>(3, 3) = -error.scale * error.rotation.toRotationMatrix();
    by_b(6, 6) = -1.0;
    Write(inverse_sigma_, by_b, jacobians[1]);
  }
  return true;
}

}  // namespace hullslam
