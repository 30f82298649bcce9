// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/restored_map.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/util/error.h"
#include "map_files/invariants.h"

namespace hullslam {
namespace {

[[noreturn]] void Fail(const std::string& kind, uint32_t id, const std::string& what) {
  throw InputError(kind + ' ' + std::to_string(id) + ' ' + what);
}

void Require(bool condition, KeyframeId id, const char* what) {
  if (!condition) {
    Fail("keyframe", id.value, what);
  }
}

// The number of keyframes that the map has had. Every id below it belongs to a keyframe or to a
// culled keyframe.
uint32_t CountKeyframes(const MapTables& tables) {
  return std::max(tables.keyframes.NextId().value, tables.culled.NextId().value);
}

// Map::KeyframeOfFrame finds one keyframe by its frame.
void CheckFrames(const MapTables& tables) {
  constexpr uint32_t kMostFrames = uint32_t{1} << 31;  // later sessions need ids too
  FrameId last;
  std::set<FrameId> frames;
  for (uint32_t i = 0; i < CountKeyframes(tables); ++i) {
    const KeyframeId id(i);
    const Keyframe* keyframe = tables.keyframes.Find(id);
    const CulledKeyframe* culled = tables.culled.Find(id);
    Require((keyframe == nullptr) != (culled == nullptr), id, "is missing or is twice there");
    const FrameId frame = keyframe != nullptr ? keyframe->frame->id : culled->frame;
    Require(frame.value < kMostFrames && frames.insert(frame).second, id,
            "has a frame that is too late or is that of another keyframe");
    last = last.IsValid() ? std::max(last, frame) : frame;
  }
  const Session* before = nullptr;
  for (const Session& session : tables.sessions) {
    if (before != nullptr && !(before->first_frame < session.first_frame)) {
      throw InputError("the sessions are out of order");
    }
    before = &session;
  }
  if (before != nullptr && (!last.IsValid() || last < before->first_frame)) {
    throw InputError("the last session has no keyframe");
  }
}

enum class Pose : uint8_t { kUnknown, kSought, kKnown, kNone };

// Whether each keyframe has a pose, by its id. The pose of a culled keyframe is relative to another
// one, which may be culled too, and so on. The last one must be alive, or have been removed with
// its island: then none of them has a pose.
std::vector<Pose> FindPoses(const MapTables& tables) {
  std::vector<Pose> poses(CountKeyframes(tables), Pose::kUnknown);
  tables.keyframes.ForEach([&](KeyframeId id, const Keyframe&) { poses[id.value] = Pose::kKnown; });
  tables.culled.ForEach([&](KeyframeId id, const CulledKeyframe&) {
    std::vector<KeyframeId> path;
    while (id.value < poses.size() && poses[id.value] == Pose::kUnknown) {
      poses[id.value] = Pose::kSought;
      path.push_back(id);
      id = tables.culled.At(id).pose.reference;
    }
    Require(!id.IsValid() || id.value < poses.size(), id,
            "does not exist but a culled keyframe refers to it");
    const Pose found = id.IsValid() ? poses[id.value] : Pose::kNone;
    Require(found != Pose::kSought, id, "is culled and refers to itself");
    for (const KeyframeId passed : path) {
      poses[passed.value] = found;
    }
  });
  return poses;
}

void CheckReference(const MapTables& tables, KeyframeId reference, const std::string& kind,
                    uint32_t id) {
  if (reference.IsValid() && reference.value >= CountKeyframes(tables)) {
    Fail(kind, id, "refers to a keyframe that does not exist");
  }
}

// Checks that the keyframe exists, culled or not, and has a pose because it was not removed with
// its island.
void CheckPose(const MapTables& tables, const std::vector<Pose>& poses, KeyframeId reference,
               const std::string& kind, uint32_t id) {
  CheckReference(tables, reference, kind, id);
  if (reference.IsValid() && poses[reference.value] == Pose::kNone) {
    Fail(kind, id, "refers to a keyframe without a pose");
  }
}

void CheckReferences(const MapTables& tables) {
  const std::vector<Pose> poses = FindPoses(tables);
  tables.landmarks.ForEach([&](LandmarkId id, const Landmark& landmark) {
    CheckPose(tables, poses, landmark.reference, "landmark", id.value);
    CheckReference(tables, landmark.created_by, "landmark", id.value);
  });
  tables.objects.ForEach([&](ObjectId id, const ObjectLandmark& object) {
    CheckPose(tables, poses, object.reference, "object", id.value);
    for (const MisfitSample& sample : object.misfit_samples) {
      CheckReference(tables, sample.keyframe, "object", id.value);
    }
  });
}

void CheckWords(const MapTables& tables, const Vocabulary& vocabulary) {
  tables.keyframes.ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    for (const WordId word : keyframe.frame->words.get()) {
      Require(word.value < vocabulary.word_count(), id, "has a word that is not in the vocabulary");
    }
  });
}

std::vector<KeyframeId> IdsOf(const MapTables& tables) {
  std::vector<KeyframeId> ids;
  tables.keyframes.ForEach([&](KeyframeId id, const Keyframe&) { ids.push_back(id); });
  return ids;
}

void DeriveChildren(MapTables& tables) {
  for (const KeyframeId id : IdsOf(tables)) {
    const KeyframeId parent = tables.keyframes.At(id).parent;
    if (parent.IsValid()) {
      Require(tables.keyframes.Contains(parent), id, "has a parent that does not exist");
      tables.keyframes.Mutable(parent).children.push_back(id);
    }
  }
}

// Numbers the islands by their roots, which have no parent, if the keyframes do not tell theirs.
void DeriveIslands(MapTables& tables) {
  IslandId island(0);
  for (const KeyframeId root : IdsOf(tables)) {
    if (tables.keyframes.At(root).parent.IsValid() || tables.keyframes.At(root).island.IsValid()) {
      continue;
    }
    std::vector<KeyframeId> tree = {root};
    for (size_t i = 0; i < tree.size(); ++i) {
      Keyframe& keyframe = tables.keyframes.Mutable(tree[i]);
      keyframe.island = island;
      tree.insert(tree.end(), keyframe.children.begin(), keyframe.children.end());
    }
    ++island.value;
  }
}

// An island begins with a keyframe, so there have been no more islands than keyframes.
void CheckIslands(const MapTables& tables) {
  tables.keyframes.ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    Require(keyframe.island.value < CountKeyframes(tables), id, "is in an island that cannot be");
  });
}

// Adds the observation of an entity by a keyframe. Keyframes come in the order of their ids.
template <typename Observations>
void AppendObservation(Observations& observations, KeyframeId keyframe, uint32_t index) {
  Require(observations.empty() || observations.back().keyframe != keyframe, keyframe,
          "observes something twice");
  observations.push_back({keyframe, index});
}

void DeriveObservations(MapTables& tables) {
  for (const KeyframeId id : IdsOf(tables)) {
    const Keyframe& keyframe = tables.keyframes.At(id);
    for (uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
      if (const LandmarkId observed = keyframe.landmarks[i]; observed.IsValid()) {
        Require(tables.landmarks.Contains(observed), id, "observes a landmark that does not exist");
        Landmark& landmark = tables.landmarks.Mutable(observed);
        AppendObservation(landmark.observations, id, i);
        landmark.observation_weight += Map::ObservationWeight(*keyframe.frame, i);
      }
    }
    for (uint32_t i = 0; i < keyframe.objects.size(); ++i) {
      if (const ObjectId observed = keyframe.objects[i]; observed.IsValid()) {
        Require(tables.objects.Contains(observed), id, "observes an object that does not exist");
        AppendObservation(tables.objects.Mutable(observed).observations, id, i);
      }
    }
  }
}

}  // namespace

Map RestoreMap(MapTables tables, std::shared_ptr<const Vocabulary> vocabulary) {
  CheckFrames(tables);
  if (vocabulary != nullptr) {
    CheckWords(tables, *vocabulary);
  }
  CheckReferences(tables);
  DeriveChildren(tables);
  DeriveIslands(tables);
  CheckIslands(tables);
  DeriveObservations(tables);
  tables.keyframes.SkipIds(KeyframeId(CountKeyframes(tables)));
  Map map(std::move(tables), std::move(vocabulary));
  if (const std::vector<std::string> violations = FindViolations(map); !violations.empty()) {
    throw InputError(violations.front());
  }
  return map;
}

}  // namespace hullslam
