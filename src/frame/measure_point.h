// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "camera/point_measurement.h"
#include "hullslam/features/feature_grid.h"
#include "hullslam/frame/depth_grid.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// The measurement of a point by a keypoint of a frame. `error` is Sensor::depth_error, or the
// result of its ForAdjustment() for bundle adjustment.
PointMeasurement MeasurePoint(const Sensor& sensor, const FrameFeatures& features,
                              uint32_t keypoint, const DepthErrorOptions& error);

// The sensor with larger errors of keypoints and depths, for images that are taken far apart.
// Landmarks are then seen from elsewhere, so errors of their depths show in the image, and so do
// those of the calibration and of a rolling shutter. In a recording of a phone with depth,
// landmarks are 1.7 px and 1 to 6 px of disparity from where the depth of one keyframe says, three
// times as far as in the next image of a video.
inline constexpr double kWideErrorFactor = 3.0;
Sensor WithWideErrors(Sensor sensor);

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
// undistorted pixel to the right and down, from the samples of the grid around its raw pixel. Null
// if one of them is unknown, or if they are not on one plane.
std::optional<Eigen::Vector2d> DisparitySlope(const PinholeCamera& camera, const DepthGrid& grid,
                                              const Eigen::Vector2d& pixel,
                                              const Eigen::Vector2d& raw_pixel);

}  // namespace hullslam
