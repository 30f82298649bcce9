// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/reduced_points_cost.h"

#include <ceres/problem.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace hullslam::internal {
namespace {

// An order of elimination with little fill-in: approximate minimum degree.
std::vector<uint32_t> OrderOf(const std::vector<std::vector<uint32_t>>& coupled) {
  const auto size = static_cast<int>(coupled.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    for (const uint32_t j : coupled[static_cast<size_t>(i)]) {
      entries.emplace_back(i, static_cast<int>(j), 1.0);
    }
  }
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  return {order.indices().begin(), order.indices().end()};
}

// The rows below the diagonal, in this order of the poses.
BlockCholesky MakeBlocks(const std::vector<std::vector<uint32_t>>& coupled,
                         const std::vector<uint32_t>& order) {
  std::vector<size_t> places(order.size());
  for (size_t k = 0; k < order.size(); ++k) {
    places[order[k]] = k;
  }
  std::vector<std::vector<uint32_t>> rows(order.size());
  for (size_t pose = 0; pose < order.size(); ++pose) {
    for (const uint32_t other : coupled[pose]) {
      if (places[other] > places[pose]) {
        rows[places[pose]].push_back(static_cast<uint32_t>(places[other]));
      }
    }
  }
  return BlockCholesky(std::move(rows));
}

}  // namespace

ReducedPointsCost::RowsOfPose::RowsOfPose(const ReducedPointsCost& all, size_t row)
    : all_(all), row_(row) {
  set_num_residuals(row + 1 < all.order_.size() ? 6 : 7);
  mutable_parameter_block_sizes()->assign(all.ColumnsOf(row).size(),
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
  values.head<6>() = all_.residual().segment<6>(6 * static_cast<Eigen::Index>(row_));
  values.tail(num_residuals() - 6)
      .setConstant(std::sqrt(std::max(0.0, twice_cost - all_.residual().squaredNorm())));
  const std::vector<uint32_t> columns = all_.ColumnsOf(row_);
  for (size_t i = 0; i < columns.size(); ++i) {
    if (jacobians[i] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> by_pose(
          jacobians[i], num_residuals(), 7);
      by_pose.setZero();
      by_pose.topLeftCorner<6, 6>() = all_.JacobianBlock(row_, columns[i]);
    }
  }
  return true;
}

ReducedPointsCost::ReducedPointsCost(EliminatedPoints& points, std::vector<PoseBlock>& poses,
                                     bool is_sparse)
    : points_(points), poses_(poses), order_(points.moving()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (is_sparse) {
    const std::vector<std::vector<uint32_t>> coupled = points.CoupledPoses();
    order_ = OrderOf(coupled);
    sparse_ = MakeBlocks(coupled, order_);
  }
  for (size_t i = 0; i < points.moving(); ++i) {
    rows_.emplace_back(*this, i);
  }
}

std::vector<uint32_t> ReducedPointsCost::ColumnsOf(size_t row) const {
  std::vector<uint32_t> columns = {static_cast<uint32_t>(row)};
  if (sparse_) {
    columns.insert(columns.end(), sparse_->RowsOf(row).begin(), sparse_->RowsOf(row).end());
  } else {
    columns.resize(order_.size() - row);
    std::iota(columns.begin(), columns.end(), row);
  }
  return columns;
}

Eigen::Matrix<double, 6, 6> ReducedPointsCost::JacobianBlock(size_t row, size_t column) const {
  return sparse_ ? sparse_->At(column, row).transpose()
                 : form_.JacobianBlock<6>(6 * static_cast<Eigen::Index>(row),
                                          6 * static_cast<Eigen::Index>(column));
}

void ReducedPointsCost::AddResiduals(ceres::Problem& problem) {
  for (size_t row = 0; row < rows_.size(); ++row) {
    std::vector<double*> parameters;
    for (const uint32_t column : ColumnsOf(row)) {
      parameters.push_back(poses_[order_[column]].data());
    }
    problem.AddResidualBlock(&rows_[row], nullptr, parameters);
  }
}

void ReducedPointsCost::FollowPoints(int times) {
  for (int i = 0; i < times; ++i) {
    PrepareForEvaluation(false, true);
    points_.Accept();
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
      points_.Linearize(order_, *sparse_, gradient_);
      has_form_ = sparse_->Factorise(gradient_);
    } else {
      points_.Linearize(form_.matrix(), gradient_);
      has_form_ = form_.Factorise(gradient_);
    }
  }
}

}  // namespace hullslam::internal
