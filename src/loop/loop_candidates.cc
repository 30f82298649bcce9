// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_candidates.h"

#include <algorithm>
#include <span>
#include <utility>

#include "loop/loop_correction.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
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
  double least = 1.0;
  for (const SimilarKeyframe& one : similar) {
    const bool is_covisible =
        std::ranges::binary_search(keyframe.covisible, one.keyframe, {}, &Covisible::keyframe);
    least = is_covisible ? std::min(least, one.score) : least;
  }
  const IdSet<KeyframeId> connected = ConnectedTo(map, query);
  std::erase_if(similar, [&](const SimilarKeyframe& one) {
    return one.score < least || connected.Contains(one.keyframe);
  });
  KeepMostCommon(similar);
  return similar;
}

using KeyframeSet = IdSet<KeyframeId>;

// For each of the keyframes most covisible with the query, the keyframes that look like it.
std::vector<KeyframeSet> SeenByNeighbours(const Map& map, KeyframeId query) {
  std::vector<KeyframeSet> seen;
  for (const KeyframeId neighbour : BestCovisible(map.keyframes().At(query), kSupporters)) {
    KeyframeSet& similar = seen.emplace_back();
    std::ranges::for_each(FindSimilar(map, neighbour),
                          [&](const SimilarKeyframe& one) { similar.Insert(one.keyframe); });
  }
  return seen;
}

}  // namespace

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
      return std::ranges::any_of(place, [&](KeyframeId member) { return seen.Contains(member); });
    };
    const auto supporters = std::ranges::count_if(seen_by_neighbours, supports);
    candidates.push_back({keyframe, static_cast<int>(supporters)});
  }
  return candidates;
}

namespace {

constexpr size_t kElsewhere = 10;  // least number of keyframes from elsewhere between two visits

// The keyframes of the query's island and session that are older than the query and not connected
// to it, by increasing id.
std::vector<KeyframeId> Elsewhere(const Map& map, KeyframeId query) {
  const auto session = [&](KeyframeId id) {
    return SessionNumber(map.sessions(), map.keyframes().At(id).frame->id);
  };
  const IdSet<KeyframeId> connected = ConnectedTo(map, query);
  std::vector<KeyframeId> elsewhere = KeyframesOf(map, IslandOf(map, query));
  std::erase_if(elsewhere, [&](KeyframeId id) {
    return id >= query || connected.Contains(id) || session(id) != session(query);
  });
  return elsewhere;
}

// Whether a loop leads from one of the keyframes to one of the others.
bool AreJoined(const Map& map, const std::vector<KeyframeId>& some,
               const std::vector<KeyframeId>& others) {
  return std::ranges::any_of(some, [&](KeyframeId id) {
    const std::vector<KeyframeId>& loops = map.keyframes().At(id).loops;
    return std::ranges::any_of(
        loops, [&](KeyframeId end) { return std::ranges::binary_search(others, end); });
  });
}

// The number of landmarks of the query that others observe too.
size_t CountShared(const Map& map, KeyframeId query, const std::vector<KeyframeId>& others) {
  const std::vector<LandmarkId> of_query = ObservedLandmarks(map, std::span(&query, 1));
  const std::vector<LandmarkId> of_others = ObservedLandmarks(map, others);
  return static_cast<size_t>(std::ranges::count_if(
      of_query, [&](LandmarkId id) { return std::ranges::binary_search(of_others, id); }));
}

}  // namespace

std::optional<Return> FindReturn(const Map& map, KeyframeId query, size_t min_landmarks) {
  const std::vector<KeyframeId> elsewhere = Elsewhere(map, query);
  if (elsewhere.size() < kElsewhere) {
    return std::nullopt;
  }
  // Between a keyframe before `bound` and the query there are enough keyframes from elsewhere.
  const KeyframeId bound = elsewhere[elsewhere.size() - kElsewhere];
  const Covisible* best = nullptr;
  for (const Covisible& other : map.keyframes().At(query).covisible) {
    if (other.keyframe < bound && (best == nullptr || other.shared > best->shared)) {
      best = &other;
    }
  }
  if (best == nullptr) {
    return std::nullopt;
  }
  const KeyframeId left = *std::upper_bound(elsewhere.begin(), elsewhere.end(), best->keyframe);
  const KeyframeId came_back = elsewhere.back();
  Return found{.query = query,
               .candidate = best->keyframe,
               .present = KeyframesAround(map, query),
               .earlier = KeyframesAround(map, best->keyframe)};
  std::erase_if(found.present, [&](KeyframeId id) { return id < came_back; });
  std::erase_if(found.earlier, [&](KeyframeId id) { return id > left; });
  const bool is_new = !AreJoined(map, found.present, found.earlier) &&
                      CountShared(map, query, found.earlier) >= min_landmarks;
  return is_new ? std::optional(std::move(found)) : std::nullopt;
}

MapCorrection JoinVisits(const Map& map, const Sensor& sensor, const Return& found,
                         const FusionOptions& fusion) {
  MapCorrection correction;
  correction.snapshot_corrections = map.correction_count();
  correction.loop = MapCorrection::LoopEdge{found.candidate, found.query};
  AddLandmarkMerges(map, sensor, found.present, found.earlier, correction);
  AddObjectMerges(map, found.present, fusion, correction);
  return correction;
}

}  // namespace hullslam
