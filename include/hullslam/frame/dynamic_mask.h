// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/frame/instance_mask.h"
#include "hullslam/features/feature_set.h"

namespace hullslam {

// Names separated by commas, blanks around them left out: "person, cat" are two.
std::set<std::string> SplitNames(std::string_view names);

// Where the raw image shows things of these classes (CV_8UC1, 255), a little more than their
// outlines; empty where it shows none.
cv::Mat DynamicMask(std::span<const InstanceMask> masks, const std::set<std::string>& classes,
                    cv::Size size);

// Takes out the keypoints whose raw position is in the mask, with their descriptors.
void RemoveMasked(const cv::Mat& mask, std::vector<Keypoint>& keypoints,
                  std::vector<Descriptor>& descriptors);

}  // namespace hullslam
