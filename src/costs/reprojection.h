// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "camera/rgbd_projection.h"

namespace hullslam {

// Reprojection error of a landmark seen without depth, in standard deviations:
//   r = (project(cam_from_world * point) - pixel) / sigma
// Parameters: cam_from_world (PoseBlock, with PoseManifold), point (m, world frame). Not defined
// for a point that is not in front of the camera: then Evaluate returns false.
class ReprojectionCost final : public ceres::SizedCostFunction<2, 7, 3> {
 public:
  ReprojectionCost(const PinholeCamera& camera, const Eigen::Vector2d& pixel, double sigma)
      : camera_(camera), pixel_(pixel), inverse_sigma_(1.0 / sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PinholeCamera camera_;
  Eigen::Vector2d pixel_;
  double inverse_sigma_;
};

}  // namespace hullslam
