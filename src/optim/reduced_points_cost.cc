// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/reduced_points_cost.h"

#include <algorithm>
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
    Linearize();
  }
}

void ReducedPointsCost::Linearize() {
  points_.Linearize(hessian_, residual_);
  // Where a pose has no inlier left, or rounding has eaten a small eigenvalue, the factor would not
  // exist.
  hessian_.diagonal().array() += 1e-12 * hessian_.diagonal().maxCoeff();
  factor_.compute(hessian_);
  factor_.matrixL().solveInPlace(residual_);
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
  if (factor_.info() != Eigen::Success) {
    return false;
  }
  all.head(size) = residual_;
  all[size] = std::sqrt(std::max(0.0, 2.0 * cost_ - residual_.squaredNorm()));
  for (size_t i = 0; i < points_.moving(); ++i) {
    if (jacobians[i] == nullptr) {
      continue;
    }
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> by_pose(jacobians[i],
                                                                                  size + 1, 7);
    by_pose.setZero();
    // The rows of L that belong to this pose are the columns of L^T.
    const Eigen::Index first = 6 * static_cast<Eigen::Index>(i);
    for (Eigen::Index row = first; row < first + 6; ++row) {
      by_pose.col(row - first).head(row + 1) =
          factor_.matrixLLT().row(row).head(row + 1).transpose();
    }
  }
  return true;
}

}  // namespace hullslam::internal
