// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <memory>

namespace hullslam {

// Wraps a cost and applies a robust loss to each residual separately: each residual r becomes
// sqrt(weight) sign(r) sqrt(rho(r^2)). Ceres itself applies a loss to the squared norm of all
// residuals of a block. With all lines of an object in one block, a single bad line would take away
// the influence of the good ones. One residual block per line would be several times slower. The
// cost that is minimised is 1/2 the sum of weight rho(r^2). `loss` is null for rho(s) = s.
class RobustRowsCost final : public ceres::CostFunction {
 public:
  RobustRowsCost(std::unique_ptr<ceres::CostFunction> cost,
                 std::unique_ptr<ceres::LossFunction> loss, double weight);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

  // The residuals without loss and weight.
  const ceres::CostFunction& plain() const { return *cost_; }

  // The contribution of a plain residual r to the sum, weight rho(r^2), and the weight of its
  // square in iteratively reweighted least squares, weight rho'(r^2).
  double CostOf(double residual) const;
  double WeightOf(double residual) const;

 private:
  std::unique_ptr<ceres::CostFunction> cost_;
  std::unique_ptr<ceres::LossFunction> loss_;
  double weight_;
};

}  // namespace hullslam
