// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/quadric_prior.h"

#include <cmath>

#include "costs/manifolds.h"

namespace hullslam {

QuadricPriorCost::QuadricPriorCost(const Ellipsoid& start, const QuadricPriorSigmas& sigmas)
    : start_(start.world_from_object),
      log_axes_(start.half_axes.array().log()),
      inverse_sigmas_(1.0 / sigmas.log_axes,
                      1.0 / (sigmas.center * std::cbrt(start.half_axes.prod())),
                      1.0 / sigmas.rotation) {}

bool QuadricPriorCost::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  const Rigid3 pose = FromBlock(parameters[0]);
  const Eigen::Map<const Eigen::Vector3d> log_axes(parameters[1]);
  Eigen::Quaterniond turn = pose.rotation * start_.rotation.conjugate();
  if (turn.w() < 0.0) {
    turn.coeffs() *= -1.0;
  }
  Eigen::Map<Eigen::Matrix<double, 9, 1>> residual(residuals);
  residual.segment<3>(0) = inverse_sigmas_[0] * (log_axes - log_axes_);
  residual.segment<3>(3) = inverse_sigmas_[1] * (pose.translation - start_.translation);
  residual.segment<3>(6) = inverse_sigmas_[2] * 2.0 * turn.vec();
  if (jacobians == nullptr) {
    return true;
  }
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 9, 7, Eigen::RowMajor>> by_pose(jacobians[0]);
    by_pose.setZero();
    by_pose.block<3, 3>(3, 0) = -inverse_sigmas_[1] * Skew(pose.translation);
    by_pose.block<3, 3>(3, 3).diagonal().setConstant(inverse_sigmas_[1]);
    // A turn by omega, applied from the left, changes the vector part by (w omega + omega x v) / 2.
    by_pose.block<3, 3>(6, 0) =
        inverse_sigmas_[2] * (turn.w() * Eigen::Matrix3d::Identity() - Skew(turn.vec()));
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 9, 3, Eigen::RowMajor>> by_log_axes(jacobians[1]);
    by_log_axes.setZero();
    by_log_axes.topRows<3>().diagonal().setConstant(inverse_sigmas_[0]);
  }
  return true;
}

}  // namespace hullslam
