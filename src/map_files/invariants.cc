// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/invariants.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace hullslam {
namespace {

std::string Name(KeyframeId id) { return "keyframe " + std::to_string(id.value); }
std::string Name(LandmarkId id) { return "landmark " + std::to_string(id.value); }
std::string Name(ObjectId id) { return "object " + std::to_string(id.value); }

bool IsFinite(const Rigid3& pose) {
  return pose.rotation.coeffs().allFinite() && pose.translation.allFinite();
}

// The entry of a keyframe in a list that must be in the order of keyframes. Null if there is none;
// also if the list is out of order, which is reported elsewhere.
template <typename Entry>
const Entry* FindEntry(const std::vector<Entry>& entries, KeyframeId id) {
  const auto it = std::lower_bound(
      entries.begin(), entries.end(), id,
      [](const Entry& entry, KeyframeId keyframe) { return entry.keyframe < keyframe; });
  return it != entries.end() && it->keyframe == id ? &*it : nullptr;
}

void CheckLandmark(const Map& map, LandmarkId id, const Landmark& landmark,
                   std::vector<std::string>& violations) {
  if (!landmark.position.allFinite()) {
    violations.push_back(Name(id) + " has no finite position");
  }
  int weight = 0;
  for (size_t i = 0; i < landmark.observations.size(); ++i) {
    const Observation& observation = landmark.observations[i];
    if (i > 0 && !(landmark.observations[i - 1].keyframe < observation.keyframe)) {
      violations.push_back(Name(id) + " has observations out of order");
    }
    const Keyframe* keyframe = map.keyframes().Find(observation.keyframe);
    if (keyframe == nullptr || observation.keypoint >= keyframe->landmarks.size() ||
        keyframe->landmarks[observation.keypoint] != id) {
      violations.push_back(Name(id) + " is not observed by " + Name(observation.keyframe));
      continue;
    }
    weight += Map::ObservationWeight(*keyframe->frame, observation.keypoint);
  }
  if (weight != landmark.observation_weight) {
    violations.push_back(Name(id) + " has a wrong observation weight");
  }
}

void CheckObservations(const Map& map, KeyframeId id, const Keyframe& keyframe,
                       std::vector<std::string>& violations) {
  if (keyframe.landmarks.size() != keyframe.frame->features.size()) {
    violations.push_back(Name(id) + " does not have one landmark entry per keypoint");
  }
  for (uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (!keyframe.landmarks[i].IsValid()) {
      continue;
    }
    const Landmark* landmark = map.landmarks().Find(keyframe.landmarks[i]);
    const Observation* const observation =
        landmark != nullptr ? FindEntry(landmark->observations, id) : nullptr;
    if (observation == nullptr || observation->keypoint != i) {
      violations.push_back(Name(id) + " observes " + Name(keyframe.landmarks[i]) +
                           ", which has no such observation");
    }
  }
}

void CheckObject(const Map& map, ObjectId id, const ObjectLandmark& object,
                 std::vector<std::string>& violations) {
  const Ellipsoid& shape = object.ellipsoid;
  if (object.has_shape && !(IsFinite(shape.world_from_object) && shape.half_axes.allFinite() &&
                            shape.half_axes.minCoeff() > 0.0)) {
    violations.push_back(Name(id) + " has no finite shape");
  }
  if (object.state == ObjectState::kMapped && !object.has_shape) {
    violations.push_back(Name(id) + " is mapped without a shape");
  }
  if (object.state == ObjectState::kMapped && object.observations.empty()) {
    violations.push_back(Name(id) + " is mapped although no keyframe observes it");
  }
  if (!object.observations.empty() && object.reference != object.observations.front().keyframe) {
    violations.push_back(Name(id) + " has a reference that is not the first to observe it");
  }
  std::map<std::string, double> votes;
  for (size_t i = 0; i < object.observations.size(); ++i) {
    const ObjectObservation& observation = object.observations[i];
    if (i > 0 && !(object.observations[i - 1].keyframe < observation.keyframe)) {
      violations.push_back(Name(id) + " has observations out of order");
    }
    const Keyframe* keyframe = map.keyframes().Find(observation.keyframe);
    if (keyframe == nullptr || observation.detection >= keyframe->objects.size() ||
        keyframe->objects[observation.detection] != id) {
      violations.push_back(Name(id) + " is not observed by " + Name(observation.keyframe));
      continue;
    }
    const Detection& detection = keyframe->frame->detections[observation.detection];
    votes[detection.label] += detection.score;
  }
  const bool same_votes =
      votes.size() == object.votes.size() &&
      std::equal(votes.begin(), votes.end(), object.votes.begin(),
                 [](const auto& a, const auto& b) {
                   return a.first == b.first && std::abs(a.second - b.second) < 1e-9;
                 });
  if (!same_votes) {
    violations.push_back(Name(id) + " has wrong votes");
  }
}

void CheckDetections(const Map& map, KeyframeId id, const Keyframe& keyframe,
                     std::vector<std::string>& violations) {
  if (keyframe.objects.size() != keyframe.frame->detections.size()) {
    violations.push_back(Name(id) + " does not have one object entry per detection");
  }
  for (const Detection& detection : keyframe.frame->detections) {
    if (std::any_of(detection.keypoints.begin(), detection.keypoints.end(),
                    [&](uint32_t i) { return i >= keyframe.frame->features.size(); })) {
      violations.push_back(Name(id) + " has a detection of a keypoint that it does not have");
    }
  }
  for (uint32_t i = 0; i < keyframe.objects.size(); ++i) {
    if (!keyframe.objects[i].IsValid()) {
      continue;
    }
    const ObjectLandmark* object = map.objects().Find(keyframe.objects[i]);
    const ObjectObservation* const observation =
        object != nullptr ? FindEntry(object->observations, id) : nullptr;
    if (observation == nullptr || observation->detection != i) {
      violations.push_back(Name(id) + " observes " + Name(keyframe.objects[i]) +
                           ", which has no such observation");
    }
  }
}

void CheckLinks(const Map& map, KeyframeId id, const Keyframe& keyframe,
                std::vector<std::string>& violations) {
  for (size_t i = 0; i < keyframe.covisible.size(); ++i) {
    const Covisible& edge = keyframe.covisible[i];
    if (i > 0 && !(keyframe.covisible[i - 1].keyframe < edge.keyframe)) {
      violations.push_back(Name(id) + " has edges out of order");
    }
    const Keyframe* other = map.keyframes().Find(edge.keyframe);
    const Covisible* back = other != nullptr ? FindEntry(other->covisible, id) : nullptr;
    if (back == nullptr || back->shared != edge.shared) {
      violations.push_back(Name(id) + " has an edge that " + Name(edge.keyframe) +
                           " does not have");
    }
  }
  for (const KeyframeId child : keyframe.children) {
    const Keyframe* other = map.keyframes().Find(child);
    if (other == nullptr || other->parent != id) {
      violations.push_back(Name(id) + " has a child with another parent: " + Name(child));
    }
  }
  if (keyframe.parent.IsValid()) {
    const Keyframe* parent = map.keyframes().Find(keyframe.parent);
    if (parent == nullptr ||
        !std::binary_search(parent->children.begin(), parent->children.end(), id)) {
      violations.push_back(Name(id) + " is not a child of its parent");
    }
  }
}

void CheckLoops(const Map& map, KeyframeId id, const Keyframe& keyframe,
                std::vector<std::string>& violations) {
  for (size_t i = 0; i < keyframe.loops.size(); ++i) {
    const KeyframeId loop = keyframe.loops[i];
    const Keyframe* other = map.keyframes().Find(loop);
    if (loop == id || other == nullptr ||
        !std::binary_search(other->loops.begin(), other->loops.end(), id)) {
      violations.push_back(Name(id) + " has a loop edge that " + Name(loop) + " does not have");
    }
    if (i > 0 && !(keyframe.loops[i - 1] < loop)) {
      violations.push_back(Name(id) + " has loop edges out of order");
    }
  }
}

enum class Ancestors : uint8_t { kUnknown, kSought, kEnd, kRepeat };

// Whether the line of parents ends at a root. `known` has what was found of each keyframe, by its
// id, so that no part of a long line is followed twice.
void CheckAncestors(const Map& map, KeyframeId id, std::vector<Ancestors>& known,
                    std::vector<std::string>& violations) {
  std::vector<KeyframeId> path;
  KeyframeId at = id;
  while (map.keyframes().Contains(at) && known[at.value] == Ancestors::kUnknown) {
    known[at.value] = Ancestors::kSought;
    path.push_back(at);
    at = map.keyframes().At(at).parent;
  }
  const bool has_end = !map.keyframes().Contains(at) || known[at.value] == Ancestors::kEnd;
  for (const KeyframeId passed : path) {
    known[passed.value] = has_end ? Ancestors::kEnd : Ancestors::kRepeat;
  }
  if (known[id.value] == Ancestors::kRepeat) {
    violations.push_back(Name(id) + " is its own ancestor");
  }
}

// Nothing leads from one island to another one.
void CheckIsland(const Map& map, KeyframeId id, const Keyframe& keyframe,
                 std::vector<std::string>& violations) {
  const auto is_elsewhere = [&](KeyframeId other) {
    const Keyframe* const found = map.keyframes().Find(other);
    return found != nullptr && found->island != keyframe.island;
  };
  for (const LandmarkId landmark : keyframe.landmarks) {
    const Landmark* const observed = map.landmarks().Find(landmark);
    if (observed != nullptr && !observed->observations.empty() &&
        is_elsewhere(observed->observations.front().keyframe)) {
      violations.push_back(Name(id) + " observes " + Name(landmark) + " of another island");
    }
  }
  for (const ObjectId object : keyframe.objects) {
    const ObjectLandmark* const observed = map.objects().Find(object);
    if (observed != nullptr && is_elsewhere(observed->reference)) {
      violations.push_back(Name(id) + " observes " + Name(object) + " of another island");
    }
  }
  if (is_elsewhere(keyframe.parent) ||
      std::any_of(keyframe.loops.begin(), keyframe.loops.end(), is_elsewhere)) {
    violations.push_back(Name(id) + " has an edge to another island");
  }
}

// Each island has one spanning tree.
void CheckRoots(const Map& map, std::vector<std::string>& violations) {
  std::map<IslandId, KeyframeId> roots;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    if (keyframe.parent.IsValid()) {
      return;
    }
    const auto [root, is_first] = roots.emplace(keyframe.island, id);
    if (!is_first) {
      violations.push_back(Name(id) + " is a second root of the island of " + Name(root->second));
    }
  });
}

// Each keyframe has the entries of its words, and there are no others.
void CheckIndex(const Map& map, std::vector<std::string>& violations) {
  size_t expected = 0;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    const BowVector vector = map.VectorOf(*keyframe.frame);
    expected += vector.size();
    const bool is_indexed =
        std::all_of(vector.begin(), vector.end(), [&](const WeightedWord& weighted) {
          const std::vector<Posting>* const postings = map.index().postings().Find(weighted.word);
          const Posting* const posting = postings != nullptr ? FindEntry(*postings, id) : nullptr;
          return posting != nullptr && *posting == Posting{id, weighted.weight};
        });
    if (!is_indexed) {
      violations.push_back(Name(id) + " has words that the index does not have");
    }
  });
  size_t count = 0;
  map.index().postings().ForEach([&](WordId word, const std::vector<Posting>& postings) {
    count += postings.size();
    if (postings.empty() ||
        !std::is_sorted(postings.begin(), postings.end(), [](const Posting& a, const Posting& b) {
          return a.keyframe < b.keyframe;
        })) {
      violations.push_back("word " + std::to_string(word.value) + " has entries out of order");
    }
  });
  if (count != expected) {
    violations.push_back("the index has " + std::to_string(count) + " entries, expected " +
                         std::to_string(expected));
  }
}

}  // namespace

std::vector<std::string> FindViolations(const Map& map) {
  std::vector<std::string> violations;
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    CheckLandmark(map, id, landmark, violations);
  });
  map.objects().ForEach(
      [&](ObjectId id, const ObjectLandmark& object) { CheckObject(map, id, object, violations); });
  std::vector<Ancestors> ancestors(map.keyframes().NextId().value, Ancestors::kUnknown);
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    if (!IsFinite(keyframe.cam_from_world)) {
      violations.push_back(Name(id) + " has no finite pose");
    }
    if (!std::isfinite(keyframe.scale) || keyframe.scale <= 0.0) {
      violations.push_back(Name(id) + " has no finite scale above 0");
    }
    CheckObservations(map, id, keyframe, violations);
    CheckDetections(map, id, keyframe, violations);
    CheckLinks(map, id, keyframe, violations);
    CheckLoops(map, id, keyframe, violations);
    CheckAncestors(map, id, ancestors, violations);
    CheckIsland(map, id, keyframe, violations);
  });
  CheckRoots(map, violations);
  CheckIndex(map, violations);
  return violations;
}

}  // namespace hullslam
