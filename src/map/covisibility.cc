// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/covisibility.h"

#include <algorithm>
#include <map>

#include "map/spanning_tree.h"
#include "util/lists.h"

namespace hullslam {
namespace {

constexpr int kMinShared = 15;  // Mur-Artal and Tardos 2015, section III.D

bool Before(const Covisible& edge, KeyframeId id) { return edge.keyframe < id; }

void SetEdge(Keyframe& keyframe, KeyframeId other, int shared) {
  auto it = std::lower_bound(keyframe.covisible.begin(), keyframe.covisible.end(), other, Before);
  if (it == keyframe.covisible.end() || it->keyframe != other) {
    it = keyframe.covisible.insert(it, {other, 0});
  }
  it->shared = shared;
}

void RemoveEdge(Keyframe& keyframe, KeyframeId other) {
  const auto it =
      std::lower_bound(keyframe.covisible.begin(), keyframe.covisible.end(), other, Before);
  if (it != keyframe.covisible.end() && it->keyframe == other) {
    keyframe.covisible.erase(it);
  }
}

std::map<KeyframeId, int> CountShared(const Map& map, KeyframeId id) {
  std::map<KeyframeId, int> shared;
  for (const LandmarkId landmark : map.keyframes().At(id).landmarks) {
    if (!landmark.IsValid()) {
      continue;
    }
    for (const Observation& observation : map.landmarks().At(landmark).observations) {
      if (observation.keyframe != id) {
        ++shared[observation.keyframe];
      }
    }
  }
  return shared;
}

bool IsMoreShared(const Covisible& a, const Covisible& b) {
  return a.shared != b.shared ? a.shared > b.shared : a.keyframe > b.keyframe;
}

}  // namespace

void UpdateCovisibility(Map& map, KeyframeId id) {
  std::vector<Covisible> edges;
  Covisible best;
  Covisible best_older;
  for (const auto& [other, shared] : CountShared(map, id)) {
    const Covisible edge{other, shared};
    if (shared >= kMinShared) {
      edges.push_back(edge);
    }
    if (!best.keyframe.IsValid() || IsMoreShared(edge, best)) {
      best = edge;
    }
    if (other < id && (!best_older.keyframe.IsValid() || IsMoreShared(edge, best_older))) {
      best_older = edge;
    }
  }
  if (edges.empty() && best.keyframe.IsValid()) {
    edges.push_back(best);
  }
  DetachCovisibility(map, id);
  for (const Covisible& edge : edges) {
    SetEdge(map.MutableKeyframe(edge.keyframe), id, edge.shared);
  }
  map.MutableKeyframe(id).covisible = std::move(edges);

  // This parent is older than its child, so the tree cannot get a cycle.
  const bool has_parent = map.keyframes().At(id).parent.IsValid();
  if (!has_parent && best_older.keyframe.IsValid()) {
    SetParent(map, id, best_older.keyframe);
  }
}

void DetachCovisibility(Map& map, KeyframeId id) {
  const std::vector<Covisible> edges = map.keyframes().At(id).covisible;
  for (const Covisible& edge : edges) {
    RemoveEdge(map.MutableKeyframe(edge.keyframe), id);
  }
  map.MutableKeyframe(id).covisible.clear();
}

std::vector<KeyframeId> BestCovisible(const Keyframe& keyframe, size_t count) {
  std::vector<Covisible> edges = keyframe.covisible;
  std::sort(edges.begin(), edges.end(), IsMoreShared);
  std::vector<KeyframeId> best;
  for (size_t i = 0; i < std::min(count, edges.size()); ++i) {
    best.push_back(edges[i].keyframe);
  }
  return best;
}

std::vector<LandmarkId> ObservedLandmarks(const Map& map, std::span<const KeyframeId> keyframes) {
  std::vector<LandmarkId> landmarks;
  for (const KeyframeId id : keyframes) {
    for (const LandmarkId landmark : map.keyframes().At(id).landmarks) {
      if (landmark.IsValid()) {
        landmarks.push_back(landmark);
      }
    }
  }
  SortUnique(landmarks);
  return landmarks;
}

}  // namespace hullslam
