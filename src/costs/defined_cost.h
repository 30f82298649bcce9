// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>

#include <memory>

namespace hullslam {

// A cost that is that of a far outlier where another one is not defined: all residuals are kFar and
// do not change. Ceres refuses every step to a place where a cost is not defined, so one point that
// a step brings behind one camera would hold the whole map.
class DefinedCost final : public ceres::CostFunction {
 public:
  static constexpr double kFar = 100.0;  // sigmas

  explicit DefinedCost(std::unique_ptr<ceres::CostFunction> cost);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  std::unique_ptr<ceres::CostFunction> cost_;
};

}  // namespace hullslam
