// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "camera/rgbd_projection.h"

namespace hullslam {

// Reprojection error of a landmark seen with depth, as the disparity of a virtual stereo pair, in
// standard deviations:
//   r = ((u, v, bf / z)(cam_from_world * point) - measured) / (sigma, sigma, kDisparitySigma)
// Mur-Artal and Tardos 2017, section III.A, have u - bf / z instead, with the pixel's sigma: that
// trusts depth the less the coarser the keypoint's level is (docs/decisions.md).
// Parameters: cam_from_world (PoseBlock, with PoseManifold), point (m, world frame). Not defined
// for a point that is not in front of the camera: Evaluate is false there.
class RgbdReprojectionCost final : public ceres::SizedCostFunction<3, 7, 3> {
 public:
  RgbdReprojectionCost(const PinholeCamera& camera, const Eigen::Vector3d& measured, double sigma)
      : camera_(camera),
        measured_(measured),
        inverse_sigma_(1.0 / sigma, 1.0 / sigma, 1.0 / kDisparitySigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PinholeCamera camera_;
  Eigen::Vector3d measured_;
  Eigen::Vector3d inverse_sigma_;
};

}  // namespace hullslam
