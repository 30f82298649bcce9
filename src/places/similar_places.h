// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// The keyframe and those that share most landmarks with it: they show one place.
std::vector<KeyframeId> PlaceOf(const Map& map, KeyframeId keyframe);

// Of keyframes that look like an image (InvertedIndex::Query), those that have nearly as many words
// in common with it as the best one (80 %, Mur-Artal and Tardos 2014).
void KeepMostCommon(std::vector<SimilarKeyframe>& similar);

// The most similar keyframe of each place, if the scores of the keyframes of this place add up to
// nearly as much as those of the best place (75 %, Mur-Artal and Tardos 2014). The order of
// `similar` is kept.
std::vector<KeyframeId> BestOfPlaces(const Map& map, const std::vector<SimilarKeyframe>& similar);

}  // namespace hullslam
