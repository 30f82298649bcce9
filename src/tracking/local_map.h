// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// The part of the map that a frame is tracked against.
struct LocalMap {
  KeyframeId reference;               // shares most landmarks with the frame; invalid without any
  std::vector<KeyframeId> keyframes;  // by increasing id
  std::vector<LandmarkId> landmarks;  // by increasing id
};

// Keyframes that observe the given landmarks (those that share most, at most `max_keyframes` in
// all), then neighbours of these in covisibility and spanning tree; and all landmarks of these
// keyframes.
LocalMap SelectLocalMap(const Map& map, std::span<const LandmarkId> landmarks,
                        size_t max_keyframes);

}  // namespace hullslam
