// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace hullslam {

// Axes (columns of a rotation) of a small box that contains the points: of all boxes with one side
// on a side of the points' convex hull, the one of least volume. (The least box of all may touch
// the hull with edges only, but is hardly smaller.) Returns nothing for fewer than four points, or
// if all are on a line.
std::optional<Eigen::Matrix3d> OrientedBoxAxes(std::span<const Eigen::Vector3d> points);

}  // namespace hullslam
