// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// Makes a keyframe of the requested frame: its observations of landmarks that still exist,
// landmarks from depth for the other keypoints (all of the first keyframe; else the close ones and
// at least the 100 nearest), its edges and its parent (its reference where it shares no landmark
// with any keyframe). Ids of the new landmarks go to `created`.
KeyframeId InsertKeyframe(Map& map, const KeyframeRequest& request, const Sensor& sensor,
                          std::vector<LandmarkId>& created);

}  // namespace hullslam
