// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// The camera of a pair that an image is from; a single camera is the left one.
enum class ImageSide { kLeft, kRight };

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
};

}  // namespace hullslam
