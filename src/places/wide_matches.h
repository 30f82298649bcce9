// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "matching/match.h"
#include "places/landmark_search.h"

namespace hullslam {

// Matches between images that are taken far apart: nothing predicts where a landmark is in the
// image, and the images may have few words in common.

// The keyframes with which a frame is compared, each once: first those nearest in time, then, if
// there is a vocabulary, those that look like it most by their words. Keyframes of the island
// `left_out` are left out.
std::vector<KeyframeId> KeyframesForWideMatches(const Map& map, const Frame& frame,
                                                IslandId left_out = IslandId());

// The keypoints of `queries` that are listed in `indices` (Match::query) and the keypoints of
// `features` that have nearly the same descriptors.
std::vector<Match> MatchWidely(const FrameFeatures& queries, std::span<const uint32_t> indices,
                               const FrameFeatures& features);

// The landmarks of a keyframe that are found in the frame by their descriptors alone: each is
// compared with all keypoints.
std::vector<FoundLandmark> MatchLandmarksOf(const Map& map, const Frame& frame,
                                            KeyframeId keyframe);

}  // namespace hullslam
