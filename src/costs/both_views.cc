// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/both_views.h"

#include <Eigen/Geometry>
#include <array>
#include <utility>

#include "costs/manifolds.h"

namespace hullslam {

BothViewsCost::BothViewsCost(std::unique_ptr<ceres::CostFunction> left,
                             std::unique_ptr<ceres::CostFunction> right, double baseline)
    : ObjectCost(static_cast<size_t>(left->num_residuals() + right->num_residuals())),
      left_(std::move(left)),
      right_(std::move(right)),
      right_from_left_(-baseline, 0.0, 0.0) {}

bool BothViewsCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  if (!left_->Evaluate(parameters, residuals, jacobians)) {
    return false;
  }
  Rigid3 right_pose = FromBlock(parameters[0]);
  right_pose.translation += right_from_left_;
  const PoseBlock right_block = ToBlock(right_pose);
  const std::array<const double*, 3> of_right = {right_block.data(), parameters[1], parameters[2]};
  const int above = left_->num_residuals();
  std::array<double*, 3> below = {};
  for (size_t i = 0; jacobians != nullptr && i < below.size(); ++i) {
    below.at(i) =
        jacobians[i] == nullptr ? nullptr : jacobians[i] + above * parameter_block_sizes()[i];
  }
  if (!right_->Evaluate(of_right.data(), residuals + above,
                        jacobians != nullptr ? below.data() : nullptr)) {
    return false;
  }
  for (int i = 0; below[0] != nullptr && i < right_->num_residuals(); ++i) {
    Eigen::Map<Eigen::Vector3d> by_turn(below[0] + 7 * i);
    const Eigen::Map<const Eigen::Vector3d> by_shift(below[0] + 7 * i + 3);
    by_turn += by_shift.cross(right_from_left_);
  }
  return true;
}

}  // namespace hullslam
