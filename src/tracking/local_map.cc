// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/local_map.h"

#include <algorithm>

#include "map/covisibility.h"

namespace hullslam {
namespace {

constexpr size_t kNeighbours = 10;

// The keyframes that observe any of the given landmarks, those that observe most first.
std::vector<Covisible> CountObservers(const Map& map, std::span<const LandmarkId> landmarks) {
  std::vector<int> votes(map.keyframes().NextId().value, 0);
  for (const LandmarkId id : landmarks) {
    const Landmark* landmark = map.landmarks().Find(id);
    if (landmark == nullptr) {
      continue;
    }
    for (const Observation& observation : landmark->observations) {
      ++votes[observation.keyframe.value];
    }
  }
  std::vector<Covisible> observers;
  for (uint32_t i = 0; i < votes.size(); ++i) {
    if (votes[i] > 0) {
      observers.push_back({KeyframeId(i), votes[i]});
    }
  }
  std::stable_sort(observers.begin(), observers.end(),
                   [](const Covisible& a, const Covisible& b) { return a.shared > b.shared; });
  return observers;
}

// A set of keyframes that keeps the order in which they were added.
class KeyframeSet {
 public:
  KeyframeSet(const Map& map, size_t capacity)
      : is_member_(map.keyframes().NextId().value, false), capacity_(capacity) {}
  void Add(KeyframeId id) {
    if (id.IsValid() && !IsFull() && !is_member_[id.value]) {
      is_member_[id.value] = true;
      members_.push_back(id);
    }
  }
  bool IsFull() const { return members_.size() >= capacity_; }
  const std::vector<KeyframeId>& members() const { return members_; }

 private:
  std::vector<bool> is_member_;
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

// The same as ObservedLandmarks, but with a bit per landmark instead of sorting. This is faster for
// the 80 keyframes of every frame.
std::vector<LandmarkId> LandmarksOf(const Map& map, const std::vector<KeyframeId>& keyframes) {
  std::vector<bool> is_local(map.landmarks().NextId().value, false);
  for (const KeyframeId id : keyframes) {
    for (const LandmarkId landmark : map.keyframes().At(id).landmarks) {
      if (landmark.IsValid()) {
        is_local[landmark.value] = true;
      }
    }
  }
  std::vector<LandmarkId> landmarks;
  for (uint32_t i = 0; i < is_local.size(); ++i) {
    if (is_local[i]) {
      landmarks.push_back(LandmarkId(i));
    }
  }
  return landmarks;
}

}  // namespace

LocalMap SelectLocalMap(const Map& map, std::span<const LandmarkId> landmarks,
                        KeyframeId last_reference, size_t max_keyframes) {
  std::vector<Covisible> observers = CountObservers(map, landmarks);
  if (observers.empty()) {
    observers.push_back({last_reference, 0});
  }
  KeyframeSet set(map, max_keyframes);
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
