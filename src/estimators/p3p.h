// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// Whether the height of a triangle over its longest side is at least 1 % of this side. If it is
// not, the three points are nearly on one line and do not determine a rotation. False for numbers
// that are not finite.
bool SpansTriangle(const std::array<Eigen::Vector3d, 3>& points);

// Up to four poses. Their order has no meaning.
struct P3pPoses {
  std::array<Rigid3, 4> cam_from_world;
  size_t count = 0;
};

// The camera poses from which three points (m, world frame) are seen along three rays (camera
// frame, any length, not zero). The distances of the points from the camera are intersections of
// quadrics; as by Persson and Nordberg ("Lambda Twist", 2018), one real root of a cubic polynomial
// gives a degenerate quadric, which is a pair of planes, and two Gauss-Newton steps remove the
// rounding errors. All points are in front of the camera, in the direction of their rays. There is
// no pose unless the points span a triangle.
P3pPoses SolveP3p(const std::array<Eigen::Vector3d, 3>& rays,
                  const std::array<Eigen::Vector3d, 3>& points);

}  // namespace hullslam
