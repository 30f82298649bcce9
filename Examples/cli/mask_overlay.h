// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/detection_builder.h"
#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// A picture (CV_8UC3, twice the size) of what the masks of a frame become, drawn over its grey
// image as it is, lens distortion included. The outlines are white, of rejected masks red with the
// reason; hulls are yellow, lines that hold a quadric green, one-sided ones orange, each a piece of
// a tangent with a tick to the outside; labels have their scores.
cv::Mat DrawMasks(const cv::Mat& grey, const PinholeCamera& camera,
                  std::span<const InstanceMask> masks, const DetectionResult& result);

}  // namespace hullslam
