// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/keyframe_graph.h"

#include <algorithm>
#include <map>

#include "util/id_set.h"

namespace hullslam {
namespace {

void Insert(std::vector<KeyframeId>& sorted, KeyframeId id) {
  sorted.insert(std::lower_bound(sorted.begin(), sorted.end(), id), id);
}

void Remove(std::vector<KeyframeId>& sorted, KeyframeId id) {
  sorted.erase(std::lower_bound(sorted.begin(), sorted.end(), id));
}

struct Adoption {
  KeyframeId child;
  KeyframeId parent;
  int shared = 0;
};

// The strongest edge between a child without new parent and a keyframe that may adopt it.
Adoption BestAdoption(const Map& map, const std::vector<KeyframeId>& waiting,
                      const std::vector<KeyframeId>& adopters) {
  Adoption best;
  for (const KeyframeId child : waiting) {
    for (const Covisible& edge : map.keyframes().At(child).covisible) {
      if (edge.shared > best.shared &&
          std::binary_search(adopters.begin(), adopters.end(), edge.keyframe)) {
        best = {child, edge.keyframe, edge.shared};
      }
    }
  }
  return best;
}

}  // namespace

void SetParent(Map& map, KeyframeId child, KeyframeId parent) {
  const KeyframeId former = map.keyframes().At(child).parent;
  if (former == parent) {
    return;
  }
  if (former.IsValid()) {
    Remove(map.MutableKeyframe(former).children, child);
  }
  map.MutableKeyframe(child).parent = parent;
  if (parent.IsValid()) {
    Insert(map.MutableKeyframe(parent).children, child);
  }
}

void MakeRoot(Map& map, KeyframeId keyframe) {
  std::vector<KeyframeId> path;  // up to the former root
  for (KeyframeId id = keyframe; id.IsValid(); id = map.keyframes().At(id).parent) {
    path.push_back(id);
  }
  for (size_t i = path.size() - 1; i > 0; --i) {
    SetParent(map, path[i - 1], KeyframeId());
    SetParent(map, path[i], path[i - 1]);
  }
}

void DetachFromTree(Map& map, KeyframeId id) {
  const KeyframeId parent = map.keyframes().At(id).parent;
  std::vector<KeyframeId> waiting = map.keyframes().At(id).children;
  std::vector<KeyframeId> adopters = {parent};
  while (!waiting.empty()) {
    Adoption adoption = BestAdoption(map, waiting, adopters);
    if (!adoption.child.IsValid()) {
      adoption = {waiting.front(), parent, 0};
    }
    SetParent(map, adoption.child, adoption.parent);
    Remove(waiting, adoption.child);
    Insert(adopters, adoption.child);
  }
  SetParent(map, id, KeyframeId());
}

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

bool AreConnected(const Map& map, KeyframeId a, KeyframeId b) {
  IdSet<KeyframeId> reached;
  reached.Insert(a);
  std::vector<KeyframeId> waiting{a};
  const bool may_be_apart = map.keyframes().At(a).frame->motion.has_value();
  while (may_be_apart && !waiting.empty() && !reached.Contains(b)) {
    const Keyframe& keyframe = map.keyframes().At(waiting.back());
    waiting.pop_back();
    for (const Covisible& edge : keyframe.covisible) {
      if (edge.shared >= kMinShared && reached.Insert(edge.keyframe)) {
        waiting.push_back(edge.keyframe);
      }
    }
  }
  return !may_be_apart || reached.Contains(b);
}

bool IsTied(const Map& map, KeyframeId keyframe) {
  const KeyframeId parent = map.keyframes().At(keyframe).parent;
  return parent.IsValid() && !AreConnected(map, keyframe, parent);
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
  IdSet<LandmarkId> observed;
  for (const KeyframeId id : keyframes) {
    for (const LandmarkId landmark : map.keyframes().At(id).landmarks) {
      if (landmark.IsValid()) {
        observed.Insert(landmark);
      }
    }
  }
  return observed.Sorted();
}

}  // namespace hullslam
