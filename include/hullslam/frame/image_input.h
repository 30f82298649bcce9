// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "hullslam/frame/instance_mask.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The camera of a pair that an image is from; a single camera is the left one.
enum class ImageSide { kLeft, kRight };

// The motion of the camera from the frame before, as wheels or an inertial sensor measure it.
struct MotionPrior {
  // m; maps points from the camera frame of the frame before to that of this frame.
  Rigid3 cam_from_last_cam;
  double last_timestamp = 0.0;  // s, of the frame before
  // The covariance of the small motion d by which it is wrong: the true motion is
  // Retract(cam_from_last_cam, d), d = (rotation in rad, translation in m) in the axes of the
  // camera at this frame. Symmetric and positive definite.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
};

// One input frame; depth is registered to the colour image and has its shape, maybe not its size.
struct ImageInput {
  double timestamp = 0.0;  // seconds
  cv::Mat grey;            // CV_8UC1
  // CV_16UC1 in units of 1 / DepthMapFactor metres, or CV_32FC1 in metres. The depth is unknown
  // where the value is 0 or not finite. Empty for a monocular and for a stereo camera.
  cv::Mat depth;
  std::vector<InstanceMask> masks = {};  // masks of the objects in the image; may be empty
  // The right image of a stereo camera, CV_8UC1, rectified: a point lies in the same row of both.
  // Empty for other sensors.
  cv::Mat right = {};
  // Masks of the objects in the right image; may be empty, also beside other masks.
  std::vector<InstanceMask> right_masks = {};
  double depth_delay = 0.0;  // s, from the exposure of the image to that of the depth image
  // Needs a camera with depth or a stereo camera, because it is in metres.
  std::optional<MotionPrior> motion = {};
};

}  // namespace hullslam
