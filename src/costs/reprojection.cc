// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/reprojection.h"

#include "costs/reprojection_evaluation.h"

namespace hullslam {

bool ReprojectionCost::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  return internal::EvaluateReprojection<2>(camera_, measurement_, parameters, residuals, jacobians);
}

}  // namespace hullslam
