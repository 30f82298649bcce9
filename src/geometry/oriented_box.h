// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace hullslam {

// Axes (columns of a rotation) of the box of least volume that contains the points (Chang, Gorissen
// and Melchior 2011, by CGAL). Deterministic. Returns nothing for fewer than four points.
std::optional<Eigen::Matrix3d> OrientedBoxAxes(std::span<const Eigen::Vector3d> points);

}  // namespace hullslam
