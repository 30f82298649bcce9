// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/defined_cost.h"

#include <algorithm>
#include <utility>

namespace hullslam {

DefinedCost::DefinedCost(std::unique_ptr<ceres::CostFunction> cost) : cost_(std::move(cost)) {
  set_num_residuals(cost_->num_residuals());
  *mutable_parameter_block_sizes() = cost_->parameter_block_sizes();
}

bool DefinedCost::Evaluate(double const* const* parameters, double* residuals,
                           double** jacobians) const {
  if (cost_->Evaluate(parameters, residuals, jacobians)) {
    return true;
  }
  std::fill_n(residuals, num_residuals(), kFar);
  for (size_t i = 0; jacobians != nullptr && i < parameter_block_sizes().size(); ++i) {
    if (jacobians[i] != nullptr) {
      std::fill_n(jacobians[i], num_residuals() * parameter_block_sizes()[i], 0.0);
    }
  }
  return true;
}

}  // namespace hullslam
