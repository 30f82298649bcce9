// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// How points of the world move in the camera frame: dx/dt = angular x x + linear.
struct PointVelocity {
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  // rad/s
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   // units of the map per second
};

// The mean velocity during a motion `cam_from_last_cam` that took `duration` (s, not 0).
PointVelocity MeanVelocity(const Rigid3& cam_from_last_cam, double duration);

// How fast the image of a point moves, px/s. The point is at an undistorted pixel; its inverse
// depth is 0 if it is infinitely far away.
Eigen::Vector2d ImageVelocity(const PinholeCamera& camera, const PointVelocity& velocity,
                              const Eigen::Vector2d& pixel, double inverse_depth);

// The frame of a rolling shutter as a global shutter would have taken it when the middle row was
// exposed. A rolling shutter exposes one row after the other during Sensor::readout_time, and the
// camera moves meanwhile. Keypoints are moved back by what their points have moved in the image
// since the middle row; detections by what a point at their centre has moved. Their inverse depth
// is the median of their keypoints, or of all keypoints if that of none of theirs is known.
// `inverse_depths`: one per keypoint, 0 where it is unknown.
std::shared_ptr<const Frame> WithGlobalShutter(const Frame& frame, const Sensor& sensor,
                                               const PointVelocity& velocity,
                                               std::span<const double> inverse_depths);

}  // namespace hullslam
