// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// Compacts the keyframes that later work hardly needs in full (map/compaction.h): those that are
// more than 20 keyframes older than `current` and are covisible neither with it nor with a keyframe
// that is. `full` are the keyframes that may have to be compacted, by increasing id. Those that are
// compacted, or culled, are removed from it.
//
// Keypoints that show no landmark are there to be triangulated with new keyframes. With every
// keyframe that was made near this one, that was tried already. Place recognition and
// relocalisation need keypoints that show landmarks.
void CompactOldKeyframes(Map& map, KeyframeId current, std::vector<KeyframeId>& full);

}  // namespace hullslam
