// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"

namespace hullslam {

// Gives a keyframe the detections of its frame, and takes away its keypoints on things of the
// dynamic classes with the landmarks that they show. Does nothing and returns false if the keyframe
// has detections already, or if it is an old one, which keeps only some of its keypoints.
bool AddLateDetections(Map& map, KeyframeId keyframe, const LateDetections& late);

// The request to make a keyframe of a frame that is none yet but shows objects, which the map
// cannot know otherwise. The landmarks on things of the dynamic classes are removed from the map.
// Nothing if the frame shows no object, has no pose, or has it in a part of the map that was
// removed.
std::optional<KeyframeRequest> RequestLateKeyframe(Map& map, const LateDetections& late);

}  // namespace hullslam
