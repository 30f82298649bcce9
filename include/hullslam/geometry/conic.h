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
  // The dual conic, scaled so that its last element is -1: C* = [[S - m m^T, -m], [-m^T, -1]] with
  // shape S and centre m. For a line l with unit normal, l^T C* l = h^2 - d^2, where h is the half
  // extent along the normal and d the distance of the centre from the line.
  Eigen::Matrix3d DualConic() const;
  // Convex polygon with `vertices` corners and the same area as the ellipse. Its corners are
  // equally spaced in the parameter of the ellipse and have positive signed area.
  std::vector<Eigen::Vector2d> Polygon(int vertices = 64) const;
};

// The ellipse of a dual conic of any scale. Returns nothing if the conic is no ellipse (a
// hyperbola, degenerate, or not finite).
std::optional<Ellipse> EllipseFromDualConic(const Eigen::Matrix3d& dual_conic);

// Least-squares ellipse through the points of a closed contour (the `conic` primitive). Returns
// nothing for fewer than five points, or if the points determine no ellipse.
std::optional<Ellipse> FitEllipse(std::span<const Eigen::Vector2d> contour);

}  // namespace hullslam
