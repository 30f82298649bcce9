// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/types.hpp>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// The file of a frame with these masks in the format yolo-seg (docs/masks.md) or, of boxes, in
// YOLO's form of the format boxes, both with scores. A line has the first outline of its mask;
// coordinates half a pixel outside the image become 0 or 1. `classes` has the names by number, and
// the label of each mask.
std::string YoloText(std::span<const InstanceMask> masks, const std::vector<std::string>& classes,
                     const cv::Size& image);

// The outlines and scores that a reader of this file has, of masks that are no boxes. A run with
// masks from a network rounds them so, and then has the bits of a run with masks from files.
void RoundAsYoloText(const cv::Size& image, std::vector<InstanceMask>& masks);

}  // namespace hullslam
