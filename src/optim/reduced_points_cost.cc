// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/reduced_points_cost.h"

#include <ceres/problem.h>

#include <cmath>

namespace hullslam::internal {

ReducedPointsCost::RowsOfPose::RowsOfPose(const ReducedPointsCost& all, size_t pose)
    : all_(all), first_(6 * static_cast<Eigen::Index>(pose)) {
  const size_t dependent = all.points_.moving() - pose;
  set_num_residuals(dependent > 1 ? 6 : 7);
  mutable_parameter_block_sizes()->assign(dependent, static_cast<int>(PoseBlock().size()));
}

bool ReducedPointsCost::RowsOfPose::Evaluate(double const* const* /*parameters*/, double* residuals,
                                             double** jacobians) const {
  if (!std::isfinite(all_.cost_)) {
    return false;
  }
  // Without derivatives Ceres needs only the cost, so the last residual contains all of it.
  const double twice_cost = 2.0 * all_.cost_;
  Eigen::Map<Eigen::VectorXd> values(residuals, num_residuals());
  values.setZero();
  if (jacobians == nullptr) {
    values.tail(num_residuals() - 6).setConstant(std::sqrt(twice_cost));
    return true;
  }
  if (!all_.has_form_) {
    return false;
  }
  values.head<6>() = all_.form_.residual().segment<6>(first_);
  values.tail(num_residuals() - 6).setConstant(all_.form_.LastResidual(twice_cost));
  for (size_t i = 0; i < parameter_block_sizes().size(); ++i) {
    if (jacobians[i] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> by_pose(
          jacobians[i], num_residuals(), 7);
      by_pose.setZero();
      by_pose.topLeftCorner<6, 6>() =
          all_.form_.JacobianBlock<6>(first_, first_ + 6 * static_cast<Eigen::Index>(i));
    }
  }
  return true;
}

ReducedPointsCost::ReducedPointsCost(EliminatedPoints& points, std::vector<PoseBlock>& poses)
    : points_(points), poses_(poses) {
  for (size_t i = 0; i < points.moving(); ++i) {
    rows_.emplace_back(*this, i);
  }
}

void ReducedPointsCost::AddResiduals(ceres::Problem& problem) {
  for (size_t i = 0; i < rows_.size(); ++i) {
    std::vector<double*> parameters;
    for (size_t j = i; j < rows_.size(); ++j) {
      parameters.push_back(poses_[j].data());
    }
    problem.AddResidualBlock(&rows_[i], nullptr, parameters);
  }
}

// Ceres asks for derivatives only at poses that it accepts.
void ReducedPointsCost::PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) {
  if (new_evaluation_point) {
    cam_from_world_.clear();
    for (const PoseBlock& pose : poses_) {
      cam_from_world_.push_back(FromBlock(pose.data()));
    }
    cost_ = points_.Follow(cam_from_world_);
    has_moved_ = true;
  }
  if (evaluate_jacobians && std::isfinite(cost_)) {
    if (has_moved_) {
      points_.Accept();
      has_moved_ = false;
    }
    points_.Linearize(form_.matrix(), gradient_);
    has_form_ = form_.Factorise(gradient_);
  }
}

}  // namespace hullslam::internal
