// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/sized_cost_function.h>

#include "camera/point_measurement.h"

namespace hullslam {

// Reprojection error of a landmark seen without depth, in standard deviations: the first two rows
// of PointResidual at cam_from_world * point,
//   r = (project(cam_from_world * point) - pixel) / (pixel_sigma * scale of the level)
// Parameters: cam_from_world (PoseBlock, with PoseManifold), point (m, world frame). Not defined
// for a point that is not in front of the camera: then Evaluate returns false.
class ReprojectionCost final : public ceres::SizedCostFunction<2, 7, 3> {
 public:
  ReprojectionCost(const PinholeCamera& camera, const PointMeasurement& measurement)
      : camera_(camera), measurement_(measurement) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PinholeCamera camera_;
  PointMeasurement measurement_;
};

}  // namespace hullslam
