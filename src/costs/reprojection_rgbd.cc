// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/reprojection_rgbd.h"

#include "costs/reprojection_evaluation.h"

namespace hullslam {

bool RgbdReprojectionCost::Evaluate(double const* const* parameters, double* residuals,
                                    double** jacobians) const {
  return internal::EvaluateReprojection<3>(camera_, measurement_, parameters, residuals, jacobians);
}

}  // namespace hullslam
