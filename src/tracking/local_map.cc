// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/local_map.h"

#include <algorithm>

#include "map/covisibility.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kNeighbours = 10;

// The keyframes that observe any of the given landmarks, those that observe most first.
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

// A set of keyframes that keeps the order in which they were added.
class KeyframeSet {
 public:
  explicit KeyframeSet(size_t capacity) : capacity_(capacity) {}
  void Add(KeyframeId id) {
    if (id.IsValid() && !IsFull() && ids_.Insert(id)) {
      members_.push_back(id);
    }
  }
  bool IsFull() const { return members_.size() >= capacity_; }
  const std::vector<KeyframeId>& members() const { return members_; }

 private:
  IdSet<KeyframeId> ids_;
  std::vector<KeyframeId> members_;
  size_t capacity_;
};

void AddNeighbours(const Map& map, KeyframeSet& set) {
  const std::vector<KeyframeId> observers = set.members();
  for (const KeyframeId id : observers) {
    if (set.IsFull()) {
      return;
    }
    const Keyframe& keyframe = map.keyframes().At(id);
    for (const KeyframeId neighbour : BestCovisible(keyframe, kNeighbours)) {
      set.Add(neighbour);
    }
    for (const KeyframeId child : keyframe.children) {
      set.Add(child);
    }
    set.Add(keyframe.parent);
  }
}

// The same as ObservedLandmarks, but with a bit set instead of sorting, which is faster for the 80
// keyframes of a local map.
std::vector<LandmarkId> LandmarksOf(const Map& map, const std::vector<KeyframeId>& keyframes) {
  IdSet<LandmarkId> local;
  for (const KeyframeId id : keyframes) {
    for (const LandmarkId landmark : map.keyframes().At(id).landmarks) {
      if (landmark.IsValid()) {
        local.Insert(landmark);
      }
    }
  }
  return local.Sorted();
}

}  // namespace

LocalMap SelectLocalMap(const Map& map, std::span<const LandmarkId> landmarks,
                        KeyframeId last_reference, size_t max_keyframes) {
  std::vector<Covisible> observers = CountObservers(map, landmarks);
  if (observers.empty()) {
    observers.push_back({last_reference, 0});
  }
  KeyframeSet set(max_keyframes);
  for (const Covisible& observer : observers) {
    set.Add(observer.keyframe);
  }
  AddNeighbours(map, set);
  LocalMap local;
  local.reference = observers.front().keyframe;
  local.keyframes = set.members();
  std::sort(local.keyframes.begin(), local.keyframes.end());
  local.landmarks = LandmarksOf(map, local.keyframes);
  return local;
}

}  // namespace hullslam
