// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Replaces the frame of a keyframe by one that has only the keypoints that show a landmark and the
// detections that show an object, without depth grid. Observations get the new indices, so that the
// map stays consistent; nothing else changes. Snapshots keep the former frame and indices. Indices
// that were taken from the keyframe before are invalid afterwards.
//
// Only this function and the next one change the frame of a keyframe. All data that the map derives
// from the keypoints of a keyframe when it is added, such as its indexed words, is updated here.
void CompactKeyframe(Map& map, KeyframeId keyframe);

// The same with other keypoints and detections, by increasing index; those that show a landmark or
// an object must be among them.
void ReduceKeyframe(Map& map, KeyframeId keyframe, std::span<const uint32_t> keypoints,
                    std::span<const uint32_t> detections);

// A frame with the same id and time that has only the given keypoints and detections. Both lists
// are of increasing indices; the new index of a keypoint or detection is its position in the list.
// Detections lose the indices of keypoints that are removed. The depth grid is removed.
//
// Every member of a frame that has one entry per keypoint must be reduced here or in
// SelectKeypoints.
std::shared_ptr<const Frame> ReduceFrame(const Frame& frame, std::span<const uint32_t> keypoints,
                                         std::span<const uint32_t> detections);

}  // namespace hullslam
