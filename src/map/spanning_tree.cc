// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/spanning_tree.h"

#include <algorithm>

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

// The strongest covisibility edge between a child without new parent and a keyframe that may adopt
// it.
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

}  // namespace hullslam
