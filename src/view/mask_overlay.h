// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

#include "frame/detection/detection_builder.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// Draws the masks of a frame and their detections over its raw grey image (with lens distortion).
// The picture is CV_8UC3 and has twice the size of the image. Outlines are white; rejected
// masks have red ones with the reason as a label. Hulls are yellow and have class and score as a
// label. Two-sided lines are green and one-sided lines orange; only a short piece of each line is
// drawn, with a tick that points to the outside.
cv::Mat DrawMasks(const cv::Mat& grey, const PinholeCamera& camera,
                  std::span<const InstanceMask> masks, const DetectionResult& result);

}  // namespace hullslam
