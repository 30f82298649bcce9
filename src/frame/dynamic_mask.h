// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "hullslam/features/feature_set.h"
#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// A mask (CV_8UC1) that is 255 at the pixels of the raw image that show things of these classes,
// and in a small margin around them. Empty if there are no such things.
cv::Mat DynamicMask(std::span<const InstanceMask> masks, const std::set<std::string>& classes,
                    cv::Size size);

// Whether the raw position of a keypoint is in the mask, which may be empty.
bool IsMasked(const cv::Mat& mask, const RawKeypoint& keypoint);

// Removes the keypoints whose raw position is in the mask, and their descriptors.
void RemoveMasked(const cv::Mat& mask, std::vector<RawKeypoint>& keypoints,
                  std::vector<Descriptor>& descriptors);

}  // namespace hullslam
