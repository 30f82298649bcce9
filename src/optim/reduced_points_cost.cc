// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/reduced_points_cost.h"

#include <ceres/problem.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hullslam::internal {

ReducedPointsCost::RowsOfPose::RowsOfPose(const ReducedPointsCost& all, size_t pose)
    : all_(all), pose_(pose) {
  set_num_residuals(pose + 1 < all.points_.moving() ? 6 : 7);
  mutable_parameter_block_sizes()->assign(all.PosesOf(pose).size(),
                                          static_cast<int>(PoseBlock().size()));
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
  const Eigen::Index first = 6 * static_cast<Eigen::Index>(pose_);
  values.head<6>() = all_.residual().segment<6>(first);
  values.tail(num_residuals() - 6)
      .setConstant(std::sqrt(std::max(0.0, twice_cost - all_.residual().squaredNorm())));
  const std::vector<size_t> poses = all_.PosesOf(pose_);
  for (size_t i = 0; i < poses.size(); ++i) {
    if (jacobians[i] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> by_pose(
          jacobians[i], num_residuals(), 7);
      by_pose.setZero();
      by_pose.topLeftCorner<6, 6>() =
          all_.sparse_
              ? BlockCholesky::Block(all_.sparse_->At(poses[i], pose_).transpose())
              : all_.form_.JacobianBlock<6>(first, 6 * static_cast<Eigen::Index>(poses[i]));
    }
  }
  return true;
}

ReducedPointsCost::ReducedPointsCost(EliminatedPoints& points, std::vector<PoseBlock>& poses,
                                     bool is_sparse)
    : points_(points), poses_(poses) {
  if (is_sparse) {
    sparse_.emplace(points.CoupledPoses());
  }
  for (size_t i = 0; i < points.moving(); ++i) {
    rows_.emplace_back(*this, i);
  }
}

std::vector<size_t> ReducedPointsCost::PosesOf(size_t pose) const {
  std::vector<size_t> poses = {pose};
  if (sparse_) {
    poses.insert(poses.end(), sparse_->RowsOf(pose).begin(), sparse_->RowsOf(pose).end());
  } else {
    poses.resize(points_.moving() - pose);
    std::iota(poses.begin(), poses.end(), pose);
  }
  return poses;
}

void ReducedPointsCost::AddResiduals(ceres::Problem& problem) {
  for (size_t i = 0; i < rows_.size(); ++i) {
    std::vector<double*> parameters;
    for (const size_t pose : PosesOf(i)) {
      parameters.push_back(poses_[pose].data());
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
    if (sparse_) {
      points_.Linearize(*sparse_, gradient_);
      has_form_ = sparse_->Factorise(gradient_);
    } else {
      points_.Linearize(form_.matrix(), gradient_);
      has_form_ = form_.Factorise(gradient_);
    }
  }
}

}  // namespace hullslam::internal
