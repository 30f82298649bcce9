// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace hullslam {

// The closed polygon with as few of its corners as keep it within `epsilon` px (Douglas and Peucker
// 1973); the same polygon for 0.
std::vector<Eigen::Vector2d> SimplifyPolygon(std::span<const Eigen::Vector2d> polygon,
                                             double epsilon);

// Signed area by the shoelace formula, px^2.
double SignedArea(std::span<const Eigen::Vector2d> polygon);

// The least box that holds the points, with sides along the axes; empty for none.
Eigen::AlignedBox2d BoundingBox(std::span<const Eigen::Vector2d> points);

}  // namespace hullslam
