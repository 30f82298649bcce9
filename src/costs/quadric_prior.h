// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "hullslam/costs/object_residual.h"
#include "hullslam/geometry/dual_quadric.h"

namespace hullslam {

// Pulls an ellipsoid towards a given shape (R0, t0, half axes s0). Silhouettes from a small range
// of viewing directions leave a part of the shape free; without the prior the ellipsoid could
// become flat or grow without limit. Nine residuals, each divided by its sigma:
//   log s - log s0,  (t - t0) / (s0_1 s0_2 s0_3)^1/3,  2 sin(angle / 2) axis of R R0^T
// Parameters: world_from_object (PoseBlock, with PoseManifold), log half axes (3, log m).
class QuadricPriorCost final : public ceres::SizedCostFunction<9, 7, 3> {
 public:
  explicit QuadricPriorCost(const Ellipsoid& start, const QuadricPriorSigmas& sigmas = {});

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Rigid3 start_;
  Eigen::Vector3d log_axes_;
  Eigen::Vector3d inverse_sigmas_;  // for log axes, centre (1 / m) and rotation (1 / rad)
};

}  // namespace hullslam
