// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/robust_rows.h"

#include <Eigen/Core>
#include <cmath>
#include <utility>

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

}  // namespace hullslam
