// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// The part of the map that a frame is tracked against.
struct LocalMap {
  KeyframeId reference;               // the keyframe that shares most landmarks with the frame
  std::vector<KeyframeId> keyframes;  // by increasing id
  std::vector<LandmarkId> landmarks;  // by increasing id
};

// Selects at most `max_keyframes` keyframes: first those that observe most of the given landmarks,
// then their neighbours in covisibility and spanning tree. If no keyframe observes any of the
// landmarks, `last_reference` is used instead of the observers. The landmarks of the local map are
// all landmarks that its keyframes observe.
LocalMap SelectLocalMap(const Map& map, std::span<const LandmarkId> landmarks,
                        KeyframeId last_reference, size_t max_keyframes);

}  // namespace hullslam
