// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "costs/quadric_in_camera.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/line2.h"

namespace hullslam {

// `algebraic_plane` (Yu et al. 2025, Eq. 8): one residual a line, pi^T Q* pi / sigma with the plane
// pi = P^T l through the camera's centre and the line, scaled to a unit normal; sigma in m^2. In
// the camera frame pi = (n, 0) with n along K^T l, so it is h^2 - d^2 with h^2 = n^T B n the
// squared half extent of the ellipsoid along n and d = n.t the distance of its centre: positive
// where the plane cuts the ellipsoid, zero at both of the tangent planes parallel to pi. One-sided:
// zero where the ellipsoid reaches the plane or lies beyond it. Parameters: those of
// QuadricInCamera. Not defined unless the quadric is in front of the camera.
class AlgebraicPlaneCost final : public ObjectCost {
 public:
  AlgebraicPlaneCost(const PinholeCamera& camera, std::span<const SilhouetteLine> lines,
                     double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  struct Plane {
    Eigen::Vector3d normal;  // camera frame
    bool is_one_sided = false;
  };
  std::vector<Plane> planes_;
  double inverse_sigma_;
};

}  // namespace hullslam
