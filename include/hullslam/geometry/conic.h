// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

namespace hullslam {

// An ellipse: points p with (p - center)^T shape^-1 (p - center) = 1; px.
struct Ellipse {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Matrix2d shape = Eigen::Matrix2d::Identity();  // symmetric, positive definite; px^2

  // Half extent along a unit direction: sqrt(n^T shape n).
  double HalfExtent(const Eigen::Vector2d& direction) const;
  Eigen::AlignedBox2d Bounds() const;
  double Area() const;
  // The dual conic scaled so that its last element is -1 (design: C* = [[S - m m^T, -m], [-m^T,
  // -1]]): l^T C* l = h^2 - d^2 for a line l with unit normal.
  Eigen::Matrix3d DualConic() const;
  // Convex polygon of the same area with `vertices` corners on rays of equal parameter, in the
  // order of positive signed area.
  std::vector<Eigen::Vector2d> Polygon(int vertices = 64) const;
};

// The ellipse of a dual conic of any scale; nothing where it is none (a hyperbola, flat, not
// finite).
std::optional<Ellipse> EllipseFromDualConic(const Eigen::Matrix3d& dual_conic);

// Least-squares ellipse of a closed contour's points (the `conic` primitive); nothing for fewer
// than five points or where they hold none.
std::optional<Ellipse> FitEllipse(std::span<const Eigen::Vector2d> contour);

}  // namespace hullslam
