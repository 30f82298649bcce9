// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

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

// The frame of a rolling shutter as a global shutter would have taken it when the middle row (or
// column) was exposed. A rolling shutter exposes one row of the raw image after the other during
// Sensor::readout_time, and the camera moves meanwhile. Keypoints and the outlines of detections
// are moved back by the motion of their points since the exposure of the middle row. All points of
// a detection have one inverse depth: the median over its keypoints, or over all keypoints if none
// of its own is known. `inverse_depths`: one per keypoint, 0 where it is unknown. Depths are those
// that would have been measured at that time: also depth images have rows, and may be taken earlier
// or later than the colour image (Frame::depth_delay, Sensor::depth_time).
std::shared_ptr<const Frame> WithGlobalShutter(const Frame& frame, const Sensor& sensor,
                                               const PointVelocity& velocity,
                                               std::span<const double> inverse_depths);

// What the shutter of a frame was corrected with.
struct ShutterMotion {
  PointVelocity velocity;
  std::vector<double> inverse_depths;  // one per keypoint, 0 where it is unknown
  std::vector<float> depths;           // of the frame as read, one per keypoint
};

// The undistorted pixel in the image as read of the keypoint `index`, which was corrected to
// `corrected`.
Eigen::Vector2d BeforeCorrection(const Sensor& sensor, const ShutterMotion& motion,
                                 const Eigen::Vector2d& corrected, size_t index);

// Corrects detections of the frame as read in the same way. They may come later than the frame
// (Frame::shutter).
void CorrectDetections(const Sensor& sensor, const ShutterMotion& motion,
                       std::vector<Detection>& detections);

}  // namespace hullslam
