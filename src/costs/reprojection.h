// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/sized_cost_function.h>

#include "camera/point_measurement.h"

namespace hullslam {

// Reprojection error of a landmark, in standard deviations: the first kRows rows of PointResidual
// at cam_from_world * point,
//   r = ((u, v, bf / z)(cam_from_world * point) - measured) / (sigma, sigma, disparity_sigma)
// with sigma = pixel_sigma * scale of the level. There are 2 rows for a landmark seen without
// depth, and 3 with the disparity. Parameters: cam_from_world (PoseBlock, with PoseManifold), point
// (m, world frame). Not defined for a point that is not in front of the camera: then Evaluate
// returns false.
template <int kRows>
class PointReprojectionCost final : public ceres::SizedCostFunction<kRows, 7, 3> {
 public:
  PointReprojectionCost(const PinholeCamera& camera, const PointMeasurement& measurement)
      : camera_(camera), measurement_(measurement) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PinholeCamera camera_;
  PointMeasurement measurement_;
};

using ReprojectionCost = PointReprojectionCost<2>;
using RgbdReprojectionCost = PointReprojectionCost<3>;

}  // namespace hullslam
