// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "costs/ellipse_projection.h"

namespace hullslam {

// How much of a region an ellipse covers: area of the intersection over area of the union.
struct Overlap {
  double iou = 0.0;  // 0 to 1; with derivative zero where they are apart
  ByEllipse by_ellipse = ByEllipse::Zero();
};

// Exact. The region is a simple polygon, convex or not, in the order of positive signed area.
Overlap EllipseOverlap(const EllipseNumbers& ellipse, std::span<const Eigen::Vector2d> region);
// Of the ellipse's bounding box with another box. Its derivative jumps where two sides meet.
Overlap BoxOverlap(const EllipseNumbers& ellipse, const Eigen::AlignedBox2d& box);

// `overlap` (Hosseinzadeh 2019): one residual, (1 - IoU of the outline with the region) / sigma,
// or of the outline's bounding box with a box; without unit. Parameters: those of QuadricInCamera.
// Not defined unless the quadric is in front of the camera and its outline has an area.
class OverlapCost final : public ObjectCost {
 public:
  // The polygon may have either order.
  OverlapCost(const PinholeCamera& camera, std::span<const Eigen::Vector2d> region, double sigma);
  OverlapCost(const PinholeCamera& camera, const Eigen::AlignedBox2d& box, double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PinholeCamera camera_;
  std::vector<Eigen::Vector2d> region_;  // none: the box counts
  Eigen::AlignedBox2d box_;
  double inverse_sigma_;
};

}  // namespace hullslam
