// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_candidates.h"

#include <algorithm>

#include "map/covisibility.h"
#include "places/similar_places.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kSupporters = 5;  // keyframes that may support a candidate

// The keyframes that look like the query and are not connected to it. They are at least as similar
// to it as the least similar of its covisible keyframes.
std::vector<SimilarKeyframe> FindSimilar(const Map& map, KeyframeId query) {
  const Keyframe& keyframe = map.keyframes().At(query);
  std::vector<SimilarKeyframe> similar = map.index().Query(map.VectorOf(*keyframe.frame));
  IdSet<KeyframeId> covisible;
  for (const Covisible& other : keyframe.covisible) {
    covisible.Insert(other.keyframe);
  }
  double least = 1.0;
  for (const SimilarKeyframe& one : similar) {
    least = covisible.Contains(one.keyframe) ? std::min(least, one.score) : least;
  }
  const IdSet<KeyframeId> connected = ConnectedTo(map, query);
  std::erase_if(similar, [&](const SimilarKeyframe& one) {
    return one.score < least || connected.Contains(one.keyframe);
  });
  KeepMostCommon(similar);
  return similar;
}

using KeyframeSet = IdSet<KeyframeId>;

// For each of the keyframes that are most covisible with the query, the keyframes that look like
// it.
std::vector<KeyframeSet> SeenByNeighbours(const Map& map, KeyframeId query) {
  std::vector<KeyframeSet> seen;
  for (const KeyframeId neighbour : BestCovisible(map.keyframes().At(query), kSupporters)) {
    KeyframeSet& similar = seen.emplace_back();
    for (const SimilarKeyframe& one : FindSimilar(map, neighbour)) {
      similar.Insert(one.keyframe);
    }
  }
  return seen;
}

}  // namespace

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

std::vector<LoopCandidate> FindLoopCandidates(const Map& map, KeyframeId query) {
  const std::vector<KeyframeId> keyframes = BestOfPlaces(map, FindSimilar(map, query));
  if (keyframes.empty()) {
    return {};
  }
  const std::vector<KeyframeSet> seen_by_neighbours = SeenByNeighbours(map, query);
  std::vector<LoopCandidate> candidates;
  for (const KeyframeId keyframe : keyframes) {
    const std::vector<KeyframeId> place = PlaceOf(map, keyframe);
    const auto supports = [&](const KeyframeSet& seen) {
      return std::any_of(place.begin(), place.end(),
                         [&](KeyframeId member) { return seen.Contains(member); });
    };
    const auto supporters =
        std::count_if(seen_by_neighbours.begin(), seen_by_neighbours.end(), supports);
    candidates.push_back({keyframe, static_cast<int>(supporters)});
  }
  return candidates;
}

}  // namespace hullslam
