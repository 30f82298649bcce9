// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "hullslam/frame/frame.h"

namespace hullslam {

// A frame with the same id and time that has only the given keypoints and detections. Both lists
// are of increasing indices; the new index of a keypoint or detection is its position in the list.
// Detections lose the indices of keypoints that are removed. The depth grid is removed.
//
// Every member of a frame that has one entry per keypoint must be reduced here or in
// SelectKeypoints.
std::shared_ptr<const Frame> ReduceFrame(const Frame& frame, std::span<const uint32_t> keypoints,
                                         std::span<const uint32_t> detections);

}  // namespace hullslam
