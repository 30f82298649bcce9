// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hullslam/frame/depth_grid.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// The depths around the projection of a point compared with its own depth.
enum class Sight {
  kUnclear,  // it is not in view, depths are unknown, or something hides it
  kSurface,  // some depth is that of the point
  kPast,     // all depths are behind it
};

// Looks at a point in the camera frame, whose undistorted pixel is `pixel`. `tolerance` multiplies
// the largest difference of depths that counts as none.
Sight LookAt(const Sensor& sensor, const DepthGrid& grid, const Eigen::Vector2d& pixel,
             const Eigen::Vector3d& point_in_cam, double tolerance = 1.0);

// How the disparity (bf / z) of a depth image changes around an undistorted pixel, px per
// undistorted pixel to the right and down, from the four samples of the grid around it. Null if one
// of them is unknown, or if they are not on one plane.
std::optional<Eigen::Vector2d> DisparitySlope(const PinholeCamera& camera, const DepthGrid& grid,
                                              const Eigen::Vector2d& pixel);

}  // namespace hullslam
