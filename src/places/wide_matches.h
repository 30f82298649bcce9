// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "places/landmark_search.h"

namespace hullslam {

// Matches between images that are taken far apart: nothing predicts where a landmark is in the
// image, and the images may have few words in common.

// The keyframes with which a frame is compared, each once: first those nearest in time, then, if
// there is a vocabulary, those that look like it most by their words. Keyframes of the island
// `left_out` are left out.
std::vector<KeyframeId> KeyframesForWideMatches(const Map& map, const Frame& frame,
                                                IslandId left_out = IslandId());

// The landmarks of a keyframe that are found in the frame by their descriptors alone: each is
// compared with all keypoints.
std::vector<FoundLandmark> MatchLandmarksOf(const Map& map, const Frame& frame,
                                            KeyframeId keyframe);

}  // namespace hullslam
