// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "costs/quadric_in_camera.h"

namespace hullslam {

// Holds an ellipsoid by points of its surface that a depth camera measured: what silhouettes from
// nearby views leave free. One residual a point p (m, camera frame): its distance from the surface
// along the ray to the centre, |y| (1 - 1 / |A^-1 y|) / sigma with y = p - t and the half axes A of
// QuadricInCamera; sigma in m. Negative inside. At the centre itself, where the ray may be any, it
// pulls nowhere. Parameters: those of QuadricInCamera.
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
