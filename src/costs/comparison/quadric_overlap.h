// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "costs/ellipse_projection.h"
#include "costs/residual_kind.h"

namespace hullslam {

// The overlap of an ellipse and a region: area of the intersection over area of the union.
struct Overlap {
  double iou = 0.0;  // 0 to 1; its derivative is zero if they are disjoint
  ByEllipse by_ellipse = ByEllipse::Zero();
};

// The exact overlap. The region is a simple polygon, convex or not, with positive signed area.
Overlap EllipseOverlap(const EllipseNumbers& ellipse, std::span<const Eigen::Vector2d> region);
// The overlap of the ellipse's bounding box with another box. Its derivative is discontinuous where
// two sides coincide.
Overlap BoxOverlap(const EllipseNumbers& ellipse, const Eigen::AlignedBox2d& box);

// `overlap` (Hosseinzadeh 2019): one residual, (1 - IoU) / sigma, without unit. The IoU is between
// the projected ellipse and the region, or between its bounding box and a box. Parameters as in
// QuadricInCamera. Not defined unless the quadric is in front of the camera and its projected
// ellipse has an area.
class OverlapCost final : public EllipseCost {
 public:
  // The polygon may have either orientation.
  OverlapCost(const PinholeCamera& camera, std::span<const Eigen::Vector2d> region, double sigma);
  OverlapCost(const PinholeCamera& camera, const Eigen::AlignedBox2d& box, double sigma);

 private:
  void Compute(const EllipseNumbers& ellipse, std::span<double> residuals,
               std::span<ByEllipse> by_ellipse) const override;

  std::vector<Eigen::Vector2d> region_;  // empty: the box is used
  Eigen::AlignedBox2d box_;
};

extern const ResidualKind kOverlapResidual;

}  // namespace hullslam
