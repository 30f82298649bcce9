// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"
#include "objects/request_memory.h"

namespace hullslam {

// The detections of a late message are those of the image as read. If the shutter of its frame was
// corrected, all functions here correct them in the same way (Frame::shutter).

// Gives a keyframe the detections of its frame, and takes away its keypoints on things of the
// dynamic classes with the landmarks that they show. Does nothing and returns false if the keyframe
// has detections already, or if it is an old one, which keeps only some of its keypoints.
bool AddLateDetections(Map& map, const Sensor& sensor, KeyframeId keyframe,
                       const LateDetections& late);

// Removes from the map the landmarks that a frame without a keyframe shows on things of the dynamic
// classes. Returns how many were removed.
size_t EraseDynamicLandmarks(Map& map, const LateDetections& late);

// The request to make a keyframe of a frame that is none yet but shows objects, which the map
// cannot know otherwise. As for masks in time (KeyframePolicy), a detection must show no mapped
// object, and no keyframe with detections may be near in time (ObjectRequestRule); keyframes that
// still wait for their masks do not count. Nothing if the frame has no pose, or has it in a part of
// the map that was removed. `memory` is that of all requests of this function.
std::optional<KeyframeRequest> RequestLateKeyframe(const Map& map, const Sensor& sensor,
                                                   const ObjectOptions& objects,
                                                   const LateDetections& late,
                                                   RequestMemory& memory);

}  // namespace hullslam
