// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "costs/ellipse_projection.h"
#include "costs/residual_kind.h"

namespace hullslam {

// `algebraic_point` (QISO-SLAM): one residual per contour point, p^T C p / sigma. The conic C is
// scaled to -1 at the centre of its ellipse, so that p^T C p = (p - m)^T S^-1 (p - m) - 1. This is
// zero on the projected ellipse. It has no unit, nor has sigma. Parameters as in
// QuadricInCamera. Not defined unless the quadric is in front of the camera and its projected
// ellipse has an area.
class AlgebraicPointCost final : public EllipseCost {
 public:
  AlgebraicPointCost(const PinholeCamera& camera, std::span<const Eigen::Vector2d> contour,
                     double sigma);

 private:
  void Compute(const EllipseNumbers& ellipse, std::span<double> residuals,
               std::span<ByEllipse> by_ellipse) const override;

  std::vector<Eigen::Vector2d> contour_;
};

// The contour points that pass a chi-square test with one degree of freedom (5 %): error^2 is at
// most 3.841 times its variance |d error / d p|^2 sigma_px^2, where both coordinates of the point
// have a sigma of sigma_px.
std::vector<Eigen::Vector2d> GateContour(std::span<const Eigen::Vector2d> contour,
                                         const Ellipse& ellipse, double sigma_px);

extern const ResidualKind kAlgebraicPointResidual;

// `filtered_point` (QISO-SLAM, Wang et al. 2023): AlgebraicPointCost with those contour points that
// pass the chi-square test of GateContour with the projected ellipse at the start of the
// optimisation. If fewer than half of the points pass, this ellipse cannot judge the contour, and
// all points are used.
extern const ResidualKind kFilteredPointResidual;

}  // namespace hullslam
