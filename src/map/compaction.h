// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "hullslam/map/map.h"

namespace hullslam {

// Replaces the frame of a keyframe by one that has only the keypoints that show a landmark and the
// detections that show an object, without depth grid. Observations get the new indices, so that the
// map stays consistent; nothing else changes. Snapshots keep the former frame and indices. Indices
// that were taken from the keyframe before are invalid afterwards.
//
// Only this function and the next one change the frame of a keyframe. All data that the map derives
// from the keypoints of a keyframe when it is added, such as an index of its words, must be updated
// here.
void CompactKeyframe(Map& map, KeyframeId keyframe);

// The same with other keypoints and detections, by increasing index; those that show a landmark or
// an object must be among them.
void ReduceKeyframe(Map& map, KeyframeId keyframe, std::span<const uint32_t> keypoints,
                    std::span<const uint32_t> detections);

}  // namespace hullslam
