// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace hullslam {

// Axes (columns of a rotation) of a small box that contains the points: the box of least volume
// among those with one side on a side of the points' convex hull. (The smallest box of all may
// touch the hull with edges only, but is hardly smaller.) Returns nothing for fewer than four
// points, or if all are on a line.
std::optional<Eigen::Matrix3d> OrientedBoxAxes(std::span<const Eigen::Vector3d> points);

}  // namespace hullslam
