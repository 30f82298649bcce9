// SPDX-License-Identifier: GPL-3.0-or-later
#include "places/similar_places.h"

#include <algorithm>

#include "map/keyframe_graph.h"

namespace hullslam {
namespace {

constexpr size_t kNeighbours = 10;
constexpr double kCommonShare = 0.8;
constexpr double kScoreShare = 0.75;

// The sum of the scores of the keyframes in `similar` that belong to the place of `keyframe`.
double PlaceScore(const Map& map, KeyframeId keyframe,
                  const std::vector<SimilarKeyframe>& similar) {
  const std::vector<KeyframeId> place = PlaceOf(map, keyframe);
  double sum = 0.0;
  for (const SimilarKeyframe& one : similar) {
    sum += std::ranges::binary_search(place, one.keyframe) ? one.score : 0.0;
  }
  return sum;
}

}  // namespace

std::vector<KeyframeId> PlaceOf(const Map& map, KeyframeId keyframe) {
  std::vector<KeyframeId> place = BestCovisible(map.keyframes().At(keyframe), kNeighbours);
  place.push_back(keyframe);
  std::ranges::sort(place);
  return place;
}

std::vector<KeyframeId> KeyframesAround(const Map& map, KeyframeId keyframe) {
  std::vector<KeyframeId> around{keyframe};
  for (const Covisible& other : map.keyframes().At(keyframe).covisible) {
    around.push_back(other.keyframe);
  }
  std::sort(around.begin(), around.end());
  return around;
}

IdSet<KeyframeId> ConnectedTo(const Map& map, KeyframeId keyframe) {
  IdSet<KeyframeId> connected;
  connected.Insert(keyframe);
  for (const Covisible& first : map.keyframes().At(keyframe).covisible) {
    connected.Insert(first.keyframe);
    for (const Covisible& second : map.keyframes().At(first.keyframe).covisible) {
      connected.Insert(second.keyframe);
    }
  }
  return connected;
}

void KeepMostCommon(std::vector<SimilarKeyframe>& similar) {
  uint32_t most = 0;
  for (const SimilarKeyframe& one : similar) {
    most = std::max(most, one.common_words);
  }
  std::erase_if(similar, [&](const auto& one) { return one.common_words < kCommonShare * most; });
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
    std::ranges::for_each(PlaceOf(map, keyframe), [&](KeyframeId id) { covered.Insert(id); });
  }
  return chosen;
}

}  // namespace hullslam
