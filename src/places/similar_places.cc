// SPDX-License-Identifier: GPL-3.0-or-later
#include "places/similar_places.h"

#include <algorithm>

#include "map/keyframe_graph.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kNeighbours = 10;
constexpr double kCommonShare = 0.8;
constexpr double kScoreShare = 0.75;

// The sum of the scores of the keyframes in `similar` that belong to the place of `keyframe`.
double PlaceScore(const Map& map, KeyframeId keyframe,
                  const std::vector<SimilarKeyframe>& similar) {
  IdSet<KeyframeId> place;
  for (const KeyframeId member : PlaceOf(map, keyframe)) {
    place.Insert(member);
  }
  double sum = 0.0;
  for (const SimilarKeyframe& one : similar) {
    sum += place.Contains(one.keyframe) ? one.score : 0.0;
  }
  return sum;
}

}  // namespace

std::vector<KeyframeId> PlaceOf(const Map& map, KeyframeId keyframe) {
  std::vector<KeyframeId> place = BestCovisible(map.keyframes().At(keyframe), kNeighbours);
  place.push_back(keyframe);
  std::sort(place.begin(), place.end());
  return place;
}

void KeepMostCommon(std::vector<SimilarKeyframe>& similar) {
  uint32_t most = 0;
  for (const SimilarKeyframe& one : similar) {
    most = std::max(most, one.common_words);
  }
  std::erase_if(similar,
                [&](const SimilarKeyframe& one) { return one.common_words < kCommonShare * most; });
}

std::vector<KeyframeId> BestOfPlaces(const Map& map, const std::vector<SimilarKeyframe>& similar) {
  std::vector<double> sums;
  sums.reserve(similar.size());
  for (const SimilarKeyframe& one : similar) {
    sums.push_back(PlaceScore(map, one.keyframe, similar));
  }
  const double best = sums.empty() ? 0.0 : *std::max_element(sums.begin(), sums.end());
  std::vector<KeyframeId> chosen;
  IdSet<KeyframeId> covered;
  for (size_t i = 0; i < similar.size(); ++i) {
    const KeyframeId keyframe = similar[i].keyframe;
    if (sums[i] < kScoreShare * best || covered.Contains(keyframe)) {
      continue;
    }
    chosen.push_back(keyframe);
    for (const KeyframeId member : PlaceOf(map, keyframe)) {
      covered.Insert(member);
    }
  }
  return chosen;
}

}  // namespace hullslam
