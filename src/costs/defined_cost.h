// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>

#include <memory>

namespace hullslam {

// Wraps a cost. Where it is undefined, returns large constant residuals (kFar) with zero
// derivatives, as for a far outlier. Ceres rejects every step to parameters at which a cost is
// undefined. So without the wrapper, a single point that a step moves behind one camera would hold
// the whole map.
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
