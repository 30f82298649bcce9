// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// Recounts the landmarks that `keyframe` shares with others and mends the edges at both ends. Edges
// need 15 shared landmarks; where no other keyframe has as many, the best one is kept. A keyframe
// without parent becomes the child of the older one it shares most with.
void UpdateCovisibility(Map& map, KeyframeId keyframe);

// Removes all edges of `keyframe`.
void DetachCovisibility(Map& map, KeyframeId keyframe);

// At most `count` neighbours, by falling number of shared landmarks, then by falling id.
std::vector<KeyframeId> BestCovisible(const Keyframe& keyframe, size_t count);

// The landmarks that any of the keyframes observes, by increasing id.
std::vector<LandmarkId> ObservedLandmarks(const Map& map, std::span<const KeyframeId> keyframes);

}  // namespace hullslam
