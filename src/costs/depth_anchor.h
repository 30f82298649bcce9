// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "costs/quadric_in_camera.h"

namespace hullslam {

// Constrains an ellipsoid by points of its surface that a depth camera measured. They constrain the
// parts of the shape that silhouettes from nearby views leave free. There is one residual per point
// p (m, camera frame), its distance from the surface along the ray to the centre:
//   |y| (1 - 1 / |A^-1 y|) / sigma
// with y = p - t, the half axes A of QuadricInCamera, and sigma in m. It is negative inside the
// ellipsoid. At the centre, where the ray has no direction, its derivative is zero. Parameters
// as in QuadricInCamera.
class DepthAnchorCost final : public ObjectCost {
 public:
  DepthAnchorCost(std::span<const Eigen::Vector3d> points, double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  std::vector<Eigen::Vector3d> points_;
  double inverse_sigma_;
};

}  // namespace hullslam
