// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace hullslam {

// Simplifies a closed polygon: removes corners that stay within `epsilon` px of the simplified
// polygon (Douglas and Peucker 1973). With `epsilon` 0 the polygon is returned unchanged.
std::vector<Eigen::Vector2d> SimplifyPolygon(std::span<const Eigen::Vector2d> polygon,
                                             double epsilon);

// Signed area by the shoelace formula, px^2.
double SignedArea(std::span<const Eigen::Vector2d> polygon);

// Whether a point is in a convex polygon of positive signed area, or at most `margin` (px) outside
// of each of the lines that bound it.
bool IsInOrNearConvex(std::span<const Eigen::Vector2d> polygon, const Eigen::Vector2d& point,
                      double margin);

// The smallest axis-aligned box that contains the points; empty if there are none.
Eigen::AlignedBox2d BoundingBox(std::span<const Eigen::Vector2d> points);

}  // namespace hullslam
