// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace hullslam {

// Corners of the convex hull in the order of positive signed area, without collinear ones, starting
// at the smallest x (then y). QuickHull (Bykat 1978), by CGAL. Points on one line give fewer than
// three corners.
std::vector<Eigen::Vector2d> ConvexHull(std::span<const Eigen::Vector2d> points);

// Polygons here are convex, closed and in the order of positive signed area. A polygon with fewer
// than three corners is the empty set.

std::vector<Eigen::Vector2d> ClipToBox(std::span<const Eigen::Vector2d> polygon,
                                       const Eigen::AlignedBox2d& box);
// The part with normal . p <= offset. The normal need not have length 1.
std::vector<Eigen::Vector2d> ClipToHalfPlane(std::span<const Eigen::Vector2d> polygon,
                                             const Eigen::Vector2d& normal, double offset);
double IntersectionArea(std::span<const Eigen::Vector2d> a, std::span<const Eigen::Vector2d> b);
// Area of the intersection over area of the union, 0 to 1; 0 for two empty sets.
double IntersectionOverUnion(std::span<const Eigen::Vector2d> a,
                             std::span<const Eigen::Vector2d> b);
double IntersectionOverUnion(const Eigen::AlignedBox2d& a, const Eigen::AlignedBox2d& b);

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
