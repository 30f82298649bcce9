// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The velocity of points of the world in the camera frame: dx/dt = cross(angular, x) + linear.
struct PointVelocity {
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  // rad/s
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   // units of the map per second
};

// The mean velocity during a motion `cam_from_last_cam` that took `duration` (s, not 0).
PointVelocity MeanVelocity(const Rigid3& cam_from_last_cam, double duration);

// The velocity of the image of a point, px/s. The point is at an undistorted pixel; its inverse
// depth is 0 if it is infinitely far away.
Eigen::Vector2d ImageVelocity(const PinholeCamera& camera, const PointVelocity& velocity,
                              const Eigen::Vector2d& pixel, double inverse_depth);

// The frame of a rolling shutter as a global shutter would have taken it when the middle row was
// exposed. A rolling shutter exposes one row after the other during Sensor::readout_time, and the
// camera moves meanwhile. Keypoints are moved back by the motion of their points in the image since
// the exposure of the middle row; detections are moved back by the motion of a point at their
// centre. The inverse depth of a detection is the median over its keypoints, or over all keypoints
// if none of its own is known. `inverse_depths`: one per keypoint, 0 where it is unknown.
std::shared_ptr<const Frame> WithGlobalShutter(const Frame& frame, const Sensor& sensor,
                                               const PointVelocity& velocity,
                                               std::span<const double> inverse_depths);

}  // namespace hullslam
