// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace hullslam {

// A distorted point of the plane z = 1, and its derivative by the undistorted point.
struct LensPoint {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;
};

}  // namespace hullslam
