// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/mapping/mapping_options.h"

namespace hullslam {

// Puts keyframes and landmarks of an initial map into the map, as a new island. The first keyframe
// is the root of its spanning tree. The ids of the landmarks are appended to `created`. Returns the
// ids of the keyframes, one per view.
std::vector<KeyframeId> InsertInitialMap(Map& map, const InitialMap& initial, const Sensor& sensor,
                                         std::vector<LandmarkId>& created);

// Makes a keyframe of the requested frame, with its edges and its parent. It observes the requested
// landmarks that still exist. Keypoints with depth that show no landmark become landmarks; by the
// rule of ORB-SLAM2 only the close ones and the hundred nearest (LandmarkRules). Their ids are
// appended to `created`. If the keyframe shares no landmark with another one, its reference becomes
// its parent.
KeyframeId InsertKeyframe(Map& map, const KeyframeRequest& request, const Sensor& sensor,
                          std::vector<LandmarkId>& created,
                          MappingRule rule = MappingRule::kHullslam);

}  // namespace hullslam
