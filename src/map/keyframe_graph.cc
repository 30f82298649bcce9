// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/keyframe_graph.h"

#include <algorithm>
#include <bit>
#include <cstdint>

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

void SetEdge(Keyframe& keyframe, KeyframeId other, int shared) {
  auto it = std::ranges::lower_bound(keyframe.covisible, other, {}, &Covisible::keyframe);
  if (it == keyframe.covisible.end() || it->keyframe != other) {
    it = keyframe.covisible.insert(it, {other, 0});
  }
  it->shared = shared;
}

bool IsMoreShared(const Covisible& a, const Covisible& b) {
  return a.shared != b.shared ? a.shared > b.shared : a.keyframe > b.keyframe;
}

}  // namespace

void UpdateCovisibility(Map& map, KeyframeId id) {
  std::vector<Covisible> edges;
  Covisible best;
  Covisible best_older;
  for (const Covisible& edge : CountObservers(map, map.keyframes().At(id).landmarks)) {
    if (edge.keyframe == id) {
      continue;
    }
    if (edge.shared >= kMinShared) {
      edges.push_back(edge);
    }
    if (!best.keyframe.IsValid() || IsMoreShared(edge, best)) {
      best = edge;
    }
    if (edge.keyframe < id && (!best_older.keyframe.IsValid() || IsMoreShared(edge, best_older))) {
      best_older = edge;
    }
  }
  if (edges.empty() && best.keyframe.IsValid()) {
    edges.push_back(best);
  }
  std::ranges::sort(edges, {}, &Covisible::keyframe);
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
    std::erase_if(map.MutableKeyframe(edge.keyframe).covisible,
                  [&](const Covisible& other) { return other.keyframe == id; });
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

std::vector<Covisible> CountObservers(const Map& map, std::span<const LandmarkId> landmarks) {
  IdMap<KeyframeId, int> votes;
  for (const LandmarkId id : landmarks) {
    const Landmark* landmark = map.landmarks().Find(id);
    if (landmark == nullptr) {
      continue;
    }
    for (const Observation& observation : landmark->observations) {
      ++votes[observation.keyframe];
    }
  }
  std::vector<Covisible> observers;
  for (const auto& [id, shared] : votes.entries()) {
    observers.push_back({id, shared});
  }
  std::sort(observers.begin(), observers.end(), [](const Covisible& a, const Covisible& b) {
    return a.shared != b.shared ? a.shared > b.shared : a.keyframe < b.keyframe;
  });
  return observers;
}

std::vector<LandmarkId> ObservedLandmarks(const Map& map, std::span<const KeyframeId> keyframes) {
  // One bit per slot. Every frame asks for some ten thousand keypoints, so those without a landmark
  // are not left out by a branch: they set a bit of the last word, which is not read.
  const uint32_t words = map.landmarks().used_slots() / 64 + 1;
  std::vector<uint64_t> is_observed(words + 1);
  for (const KeyframeId id : keyframes) {
    for (const LandmarkId landmark : map.keyframes().At(id).landmarks) {
      is_observed[std::min(landmark.slot() / 64, words)] |= uint64_t{1} << (landmark.slot() % 64);
    }
  }
  std::vector<LandmarkId> observed;
  for (uint32_t word = 0; word < words; ++word) {
    for (uint64_t left = is_observed[word]; left != 0; left &= left - 1) {
      const auto bit = static_cast<uint32_t>(std::countr_zero(left));
      observed.push_back(map.landmarks().IdInSlot(64 * word + bit));
    }
  }
  return observed;
}

}  // namespace hullslam
