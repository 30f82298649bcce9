// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/reduced_points_cost.h"

#include <cmath>

namespace hullslam::internal {

ReducedPointsCost::ReducedPointsCost(EliminatedPoints& points, const std::vector<PoseBlock>& poses)
    : points_(points), poses_(poses) {
  set_num_residuals(static_cast<int>(6 * points.moving() + 1));
  mutable_parameter_block_sizes()->assign(points.moving(), static_cast<int>(PoseBlock().size()));
}

// Ceres asks for derivatives only at poses that it keeps.
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
    points_.Linearize(hessian_, gradient_);
    has_form_ = form_.Compute(hessian_, gradient_);
  }
}

bool ReducedPointsCost::Evaluate(double const* const* /*parameters*/, double* residuals,
                                 double** jacobians) const {
  if (!std::isfinite(cost_)) {
    return false;
  }
  const Eigen::Index size = num_residuals() - 1;
  Eigen::Map<Eigen::VectorXd> all(residuals, size + 1);
  if (jacobians == nullptr) {
    all.setZero();
    all[size] = std::sqrt(2.0 * cost_);
    return true;
  }
  if (!has_form_) {
    return false;
  }
  all << form_.residual(), form_.LastResidual(2.0 * cost_);
  const Eigen::MatrixXd jacobian = form_.jacobian();
  for (size_t i = 0; i < points_.moving(); ++i) {
    if (jacobians[i] == nullptr) {
      continue;
    }
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> by_pose(jacobians[i],
                                                                                  size + 1, 7);
    by_pose.setZero();
    by_pose.topLeftCorner(size, 6) = jacobian.middleCols(6 * static_cast<Eigen::Index>(i), 6);
  }
  return true;
}

}  // namespace hullslam::internal
