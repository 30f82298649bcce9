// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace hullslam {

// Corners of the convex hull in the order of positive signed area, without collinear ones, starting
// at the smallest x (then y). QuickHull (Bykat 1978), by CGAL. Points on one line give fewer than
// three corners.
std::vector<Eigen::Vector2d> ConvexHull(std::span<const Eigen::Vector2d> points);

}  // namespace hullslam
