// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/map.h"
#include "util/id_set.h"

namespace hullslam {

// The keyframes that show the same place as a keyframe: the keyframe itself and those that share
// most landmarks with it, by increasing id.
std::vector<KeyframeId> PlaceOf(const Map& map, KeyframeId keyframe);

// The keyframe and all its covisible keyframes, by increasing id.
std::vector<KeyframeId> KeyframesAround(const Map& map, KeyframeId keyframe);

// The keyframes that tracking connects to a keyframe: the keyframe itself and all keyframes within
// two steps of the covisibility graph.
IdSet<KeyframeId> ConnectedTo(const Map& map, KeyframeId keyframe);

// Keeps, among the keyframes that look like an image (InvertedIndex::Query), those that have nearly
// as many words in common with it as the best one (80 %, Mur-Artal and Tardos 2014).
void KeepMostCommon(std::vector<SimilarKeyframe>& similar);

// The most similar keyframe of each good place. A place is good if the sum of the scores of its
// keyframes is at least 75 % of the sum of the best place (Mur-Artal and Tardos 2014). The order of
// `similar` is kept.
std::vector<KeyframeId> BestOfPlaces(const Map& map, const std::vector<SimilarKeyframe>& similar);

}  // namespace hullslam
