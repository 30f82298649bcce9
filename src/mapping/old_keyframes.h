// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// Compacts keyframes that are old, so that later steps hardly need all of their keypoints
// (map/compaction.h). These are the keyframes that are more than 20 keyframes older than `current`
// and are covisible neither with `current` nor with a keyframe that is covisible with it. `full`
// are the keyframes that may have to be compacted, by increasing id. Those that are compacted, or
// culled, are removed from it.
//
// Keypoints that show no landmark are only kept so that they can be triangulated with new
// keyframes. This was already tried with all keyframes near an old one. Place recognition and
// relocalisation need only the keypoints that show landmarks.
void CompactOldKeyframes(Map& map, KeyframeId current, std::vector<KeyframeId>& full);

}  // namespace hullslam
