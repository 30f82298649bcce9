// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>

#include "costs/ellipse_projection.h"
#include "costs/residual_kind.h"

namespace hullslam {

// The sides of a box in the order of the residuals: least x, least y, largest x, largest y.
enum BoxSide { kLeft, kTop, kRight, kBottom };

// A bound of the bounding box of an ellipse, px, and its derivative by the ellipse.
struct BoxBound {
  double value = 0.0;
  ByEllipse by_ellipse = ByEllipse::Zero();
};

// The bound of the part of an ellipse that is inside the sides of `box` for which `is_cut` is true;
// the other sides do not limit it. It belongs to the extreme point of the ellipse or, if this is
// outside, the farthest intersection with a side that is cut. If no point of the ellipse is inside,
// it is the bound of the whole ellipse.
BoxBound ClippedBound(const EllipseNumbers& ellipse, const Eigen::AlignedBox2d& box,
                      const std::array<bool, 4>& is_cut, BoxSide side);

// `box_bounds` (QuadricSLAM, Nicholson et al. 2019, section III.D): four residuals, the bounds of
// the bounding box of the projected ellipse minus the detection's box, over sigma (px).
// Where the border of the image cuts the detection, the projected ellipse is cut there too.
// Parameters as in QuadricInCamera. Not defined unless the quadric is in front of the camera
// and its projected ellipse has an area.
class BoxBoundsCost final : public EllipseCost {
 public:
  BoxBoundsCost(const PinholeCamera& camera, const Eigen::AlignedBox2d& box,
                const std::array<bool, 4>& is_cut, double sigma);

 private:
  void Compute(const EllipseNumbers& ellipse, std::span<double> residuals,
               std::span<ByEllipse> by_ellipse) const override;

  Eigen::AlignedBox2d box_;
  std::array<bool, 4> is_cut_;
};

extern const ResidualKind kBoxBoundsResidual;

}  // namespace hullslam
