// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <set>
#include <span>
#include <string>

#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// A mask (CV_8UC1) that is 255 at the pixels of the raw image that show things of these classes,
// and in a small margin around them. Empty if there are no such things.
cv::Mat DynamicMask(std::span<const InstanceMask> masks, const std::set<std::string>& classes,
                    cv::Size size);

}  // namespace hullslam
