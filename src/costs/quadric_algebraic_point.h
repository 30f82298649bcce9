// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "costs/ellipse_projection.h"

namespace hullslam {

// `algebraic_point` (QISO-SLAM): one residual a contour point, p^T C p / sigma with the conic C
// scaled to -1 at the centre of its ellipse, so that it is (p - m)^T S^-1 (p - m) - 1: without
// unit, zero on the outline, -1 at the centre; sigma without unit. Parameters: those of
// QuadricInCamera. Not defined unless the quadric is in front of the camera and its outline has an
// area.
class AlgebraicPointCost final : public ObjectCost {
 public:
  AlgebraicPointCost(const PinholeCamera& camera, std::span<const Eigen::Vector2d> contour,
                     double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PinholeCamera camera_;
  std::vector<Eigen::Vector2d> contour_;
  double inverse_sigma_;
};

// The contour points that a chi-square test with one degree of freedom (5 %) leaves: error^2 is at
// most 3.841 times its variance, propagated from an error of sigma_px in both coordinates of the
// point, |d error / d p|^2 sigma_px^2.
std::vector<Eigen::Vector2d> GateContour(std::span<const Eigen::Vector2d> contour,
                                         const Ellipse& ellipse, double sigma_px);

}  // namespace hullslam
