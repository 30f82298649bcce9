// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_candidates.h"

#include <algorithm>

#include "map/covisibility.h"
#include "places/similar_places.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kSupporters = 5;  // keyframes that may support a candidate

// Everything within two steps of the covisibility graph.
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

// What a keyframe looks like, other than what it is connected to: at least as much as the least
// similar of its covisible keyframes.
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

}  // namespace

std::vector<KeyframeId> FindLoopCandidates(const Map& map, KeyframeId query, int min_supporters) {
  std::vector<KeyframeId> candidates = BestOfPlaces(map, FindSimilar(map, query));
  if (candidates.empty() || min_supporters == 0) {
    return candidates;
  }
  std::vector<IdSet<KeyframeId>> seen_by_supporters;
  for (const KeyframeId supporter : BestCovisible(map.keyframes().At(query), kSupporters)) {
    IdSet<KeyframeId>& seen = seen_by_supporters.emplace_back();
    for (const SimilarKeyframe& s : FindSimilar(map, supporter)) {
      seen.Insert(s.keyframe);
    }
  }
  std::erase_if(candidates, [&](KeyframeId candidate) {
    const std::vector<KeyframeId> place = PlaceOf(map, candidate);
    const auto supports = [&](const IdSet<KeyframeId>& seen) {
      return std::any_of(place.begin(), place.end(),
                         [&](KeyframeId member) { return seen.Contains(member); });
    };
    return std::count_if(seen_by_supporters.begin(), seen_by_supporters.end(), supports) <
           min_supporters;
  });
  return candidates;
}

}  // namespace hullslam
