// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/wrapped_costs.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>

#include "costs/manifolds.h"

namespace hullslam {
namespace {

// Below this squared residual every loss is treated as quadratic. There the losses of Ceres, such
// as ln(1 + x), lose most digits; below 1e-16 they lose all digits, and the slope would be 1 / 0.
constexpr double kQuadratic = 1e-8;

// The loss of a squared residual and its derivative.
std::pair<double, double> Rho(const ceres::LossFunction* loss, double square) {
  if (loss == nullptr || square < kQuadratic) {
    return {square, 1.0};
  }
  double rho[3];
  loss->Evaluate(square, rho);
  return {rho[0], rho[1]};
}

// The factors by which the loss changes a residual and its derivative.
std::pair<double, double> Factors(const ceres::LossFunction* loss, double residual) {
  const double square = residual * residual;
  if (loss == nullptr || square < kQuadratic) {
    return {1.0, 1.0};
  }
  const auto [rho, slope] = Rho(loss, square);
  const double factor = std::sqrt(rho / square);
  return {factor, slope / factor};
}

}  // namespace

RobustRowsCost::RobustRowsCost(std::unique_ptr<ceres::CostFunction> cost,
                               std::unique_ptr<ceres::LossFunction> loss, double weight)
    : cost_(std::move(cost)), loss_(std::move(loss)), weight_(weight) {
  set_num_residuals(cost_->num_residuals());
  *mutable_parameter_block_sizes() = cost_->parameter_block_sizes();
}

bool RobustRowsCost::Evaluate(double const* const* parameters, double* residuals,
                              double** jacobians) const {
  if (!cost_->Evaluate(parameters, residuals, jacobians)) {
    return false;
  }
  const double root_weight = std::sqrt(weight_);
  for (int row = 0; row < num_residuals(); ++row) {
    const auto [factor, slope] = Factors(loss_.get(), residuals[row]);
    residuals[row] *= root_weight * factor;
    for (size_t block = 0; jacobians != nullptr && block < parameter_block_sizes().size();
         ++block) {
      if (jacobians[block] != nullptr) {
        const int size = parameter_block_sizes()[block];
        Eigen::Map<Eigen::VectorXd>(jacobians[block] + row * size, size) *= root_weight * slope;
      }
    }
  }
  return true;
}

double RobustRowsCost::CostOf(double residual) const {
  return weight_ * Rho(loss_.get(), residual * residual).first;
}

double RobustRowsCost::WeightOf(double residual) const {
  return weight_ * Rho(loss_.get(), residual * residual).second;
}

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
