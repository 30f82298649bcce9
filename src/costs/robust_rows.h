// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <memory>

namespace hullslam {

// A cost whose residuals are robust one by one: each r becomes sqrt(weight) sign(r) sqrt(rho(r^2)).
// Ceres itself applies a loss to all residuals of a block together, so one bad line of an object
// would silence its good ones; and a block a line would cost several times as much. The minimum is
// that of the sum of weight rho(r^2); `loss` may be null for none.
class RobustRowsCost final : public ceres::CostFunction {
 public:
  RobustRowsCost(std::unique_ptr<ceres::CostFunction> cost,
                 std::unique_ptr<ceres::LossFunction> loss, double weight);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

  // The residuals without loss and weight.
  const ceres::CostFunction& plain() const { return *cost_; }

  // What a plain residual r adds to the sum that is minimised, and the weight of its square in
  // iteratively reweighted least squares: weight rho(r^2) and weight rho'(r^2).
  double CostOf(double residual) const;
  double WeightOf(double residual) const;

 private:
  std::unique_ptr<ceres::CostFunction> cost_;
  std::unique_ptr<ceres::LossFunction> loss_;
  double weight_;
};

}  // namespace hullslam
