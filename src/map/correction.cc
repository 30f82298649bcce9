// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/correction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "hullslam/util/check.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/landmark_edits.h"
#include "util/id_set.h"
#include "util/lists.h"

namespace hullslam {
namespace {

bool IsIdentity(const MapCorrection::Pose& pose) {
  const Sim3& corrected = pose.corrected_cam_from_world;
  const Rigid3& snapshot = pose.snapshot_cam_from_world;
  return corrected.scale == 1.0 && corrected.rotation.coeffs() == snapshot.rotation.coeffs() &&
         corrected.translation == snapshot.translation;
}

// The motion of the world around each keyframe, culled or not.
class WorldChanges {
 public:
  WorldChanges(const Map& map, const MapCorrection& correction)
      : named_(map.keyframes().NextId().value, kUnknown) {
    for (const MapCorrection::Pose& pose : correction.poses) {
      const double scale = pose.corrected_cam_from_world.scale;
      Check(std::isfinite(scale) && scale > 0.0, "the scale of a correction is not positive");
      if (pose.keyframe.value < named_.size()) {
        named_[pose.keyframe.value] = static_cast<int>(changes_.size());
        changes_.push_back(IsIdentity(pose) ? std::nullopt
                                            : std::optional(Inverse(pose.corrected_cam_from_world) *
                                                            Sim3(pose.snapshot_cam_from_world)));
      }
    }
    for (uint32_t i = 0; i < named_.size(); ++i) {
      FindNamed(map, KeyframeId(i));
    }
  }

  // new_world_from_old_world of the nearest named ancestor. Null if nothing moves there.
  const Sim3* Find(KeyframeId keyframe) const {
    if (keyframe.value >= named_.size() || named_[keyframe.value] == kNone) {
      return nullptr;
    }
    const std::optional<Sim3>& change = changes_[static_cast<size_t>(named_[keyframe.value])];
    return change ? &*change : nullptr;
  }

 private:
  static constexpr int kUnknown = -2;
  static constexpr int kNone = -1;

  static KeyframeId ParentOf(const Map& map, KeyframeId id) {
    const CulledKeyframe* culled = map.FindCulled(id);
    return culled != nullptr ? culled->pose.reference : map.keyframes().At(id).parent;
  }

  // Writes the result at every keyframe on the path, so that each link is followed only once.
  void FindNamed(const Map& map, KeyframeId id) {
    std::vector<KeyframeId> path;
    while (id.IsValid() && named_[id.value] == kUnknown) {
      path.push_back(id);
      id = ParentOf(map, id);
    }
    const int found = id.IsValid() ? named_[id.value] : kNone;
    for (const KeyframeId passed : path) {
      named_[passed.value] = found;
    }
  }

  std::vector<std::optional<Sim3>> changes_;  // without a value where nothing moves
  // One entry per keyframe: the index into changes_ of its nearest named ancestor.
  std::vector<int> named_;
};

Rigid3 Moved(const Sim3& new_from_old, const Rigid3& cam_from_old) {
  const Sim3 cam_from_new = Sim3(cam_from_old) * Inverse(new_from_old);
  return {cam_from_new.rotation, new_from_old.scale * cam_from_new.translation};
}

// A culled keyframe that the correction names, as it was before.
struct CulledPose {
  KeyframeId keyframe;
  Rigid3 cam_from_world;
  double scale = 1.0;
};

// Whether the culled keyframe moves, or any keyframe that its pose depends on.
bool DependsOnMoved(const Map& map, const WorldChanges& changes, KeyframeId keyframe) {
  while (const CulledKeyframe* culled = map.FindCulled(keyframe)) {
    if (changes.Find(keyframe) != nullptr) {
      return true;
    }
    keyframe = culled->pose.reference;
  }
  return changes.Find(keyframe) != nullptr;
}

std::vector<CulledPose> CollectNamedCulled(const Map& map, const MapCorrection& correction,
                                           const WorldChanges& changes) {
  std::vector<CulledPose> collected;
  for (const MapCorrection::Pose& pose : correction.poses) {
    const KeyframeId id = pose.keyframe;
    if (map.FindCulled(id) != nullptr && DependsOnMoved(map, changes, id)) {
      collected.push_back({id, map.CamFromWorld(id), map.ScaleOf(id)});
    }
  }
  return collected;
}

void MoveKeyframes(Map& map, const MapCorrection& correction, const WorldChanges& changes) {
  const std::vector<CulledPose> culled = CollectNamedCulled(map, correction, changes);
  for (uint32_t i = 0; i < map.keyframes().NextId().value; ++i) {
    const KeyframeId id(i);
    const Sim3* change = changes.Find(id);
    if (change != nullptr && map.keyframes().Contains(id)) {
      Keyframe& keyframe = map.MutableKeyframe(id);
      keyframe.cam_from_world = Moved(*change, keyframe.cam_from_world);
      keyframe.scale *= change->scale;
    }
  }
  // A culled keyframe that the correction names has a change of its own. All other culled keyframes
  // follow the keyframe that their pose is relative to.
  for (const CulledPose& before : culled) {
    const Sim3* change = changes.Find(before.keyframe);
    CulledKeyframe& keyframe = map.MutableCulledKeyframe(before.keyframe);
    keyframe.pose = map.RelativeTo(
        map.NearestAlive(before.keyframe),
        change != nullptr ? Moved(*change, before.cam_from_world) : before.cam_from_world);
    keyframe.scale = change != nullptr ? before.scale * change->scale : before.scale;
  }
}

std::vector<MapCorrection::Position> NewPositions(const Map& map, const MapCorrection& correction,
                                                  const WorldChanges& changes) {
  std::vector<MapCorrection::Position> positions;
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    if (const Sim3* change = changes.Find(landmark.reference)) {
      positions.push_back({id, *change * landmark.position});
    }
  });
  // The given positions come last, so they count if a landmark has both.
  for (const MapCorrection::Position& given : correction.positions) {
    const Landmark* landmark = map.landmarks().Find(given.landmark);
    if (landmark != nullptr && landmark->position != given.position) {
      positions.push_back(given);
    }
  }
  return positions;
}

void MoveLandmarks(Map& map, const MapCorrection& correction, const WorldChanges& changes,
                   const ScaleLevels& levels) {
  IdSet<LandmarkId> moved;
  for (const auto& [id, position] : NewPositions(map, correction, changes)) {
    map.SetPosition(id, position);
    moved.Insert(id);
  }
  std::vector<LandmarkId> seen_anew;
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    if (moved.Contains(id) ||
        std::any_of(landmark.observations.begin(), landmark.observations.end(),
                    [&](const Observation& o) { return changes.Find(o.keyframe) != nullptr; })) {
      seen_anew.push_back(id);
    }
  });
  for (const LandmarkId id : seen_anew) {
    UpdateViewingGeometry(map, id, levels);
  }
}

void MoveObjects(Map& map, const WorldChanges& changes) {
  for (uint32_t i = 0; i < map.objects().NextId().value; ++i) {
    const ObjectLandmark* object = map.objects().Find(ObjectId(i));
    const Sim3* change = object != nullptr ? changes.Find(object->reference) : nullptr;
    if (change == nullptr || !object->has_shape) {
      continue;
    }
    ObjectLandmark& moved = map.MutableObject(ObjectId(i));
    moved.ellipsoid = *change * moved.ellipsoid;
    moved.start = *change * moved.start;
    for (auto& sample : moved.misfit_samples) {
      sample.excess *= static_cast<float>(change->scale);
    }
  }
}

// The ids that have replaced `ids`, each once.
template <typename IdType>
std::vector<IdType> ResolveAll(const Map& map, std::vector<IdType> ids) {
  for (IdType& id : ids) {
    id = map.Resolve(id);
  }
  SortUnique(ids);
  return ids;
}

void AppendObservers(const Landmark& landmark, std::vector<KeyframeId>& keyframes) {
  for (const Observation& observation : landmark.observations) {
    keyframes.push_back(observation.keyframe);
  }
}

void MergeLandmarks(Map& map, const MapCorrection& correction, const ScaleLevels& levels) {
  std::vector<LandmarkId> merged;
  std::vector<KeyframeId> observers;
  for (const MapCorrection::LandmarkMerge& merge : correction.landmarks) {
    const LandmarkId duplicate = map.Resolve(merge.duplicate);
    const LandmarkId kept = map.Resolve(merge.kept);
    if (!duplicate.IsValid() || !kept.IsValid() || duplicate == kept) {
      continue;
    }
    AppendObservers(map.landmarks().At(duplicate), observers);
    AppendObservers(map.landmarks().At(kept), observers);
    map.ReplaceLandmark(duplicate, kept);
    merged.push_back(kept);
  }
  for (const LandmarkId id : ResolveAll(map, std::move(merged))) {
    UpdateDescriptor(map, id);
    UpdateViewingGeometry(map, id, levels);
  }
  SortUnique(observers);
  for (const KeyframeId id : observers) {
    UpdateCovisibility(map, id);
  }
}

std::vector<ObjectId> MergeObjects(Map& map, const MapCorrection& correction) {
  std::vector<ObjectId> merged;
  for (const MapCorrection::ObjectMerge& merge : correction.objects) {
    ObjectId duplicate = map.Resolve(merge.duplicate);
    ObjectId kept = map.Resolve(merge.kept);
    if (!duplicate.IsValid() || !kept.IsValid() || duplicate == kept) {
      continue;
    }
    if (map.objects().At(duplicate).IsFixed()) {
      std::swap(duplicate, kept);
    }
    if (map.objects().At(duplicate).IsFixed()) {
      continue;  // both are
    }
    map.ReplaceObject(duplicate, kept);
    merged.push_back(kept);
  }
  merged = ResolveAll(map, std::move(merged));
  for (const ObjectId id : merged) {
    ObjectLandmark& object = map.MutableObject(id);
    if (!object.IsFixed()) {
      object.state = ObjectState::kCandidate;
      object.shaped_views = 0;
    }
  }
  return merged;
}

// The loop edge between the nearest ancestors of its ends that are still keyframes of the map.
std::optional<MapCorrection::LoopEdge> FindLoop(const Map& map, const MapCorrection& correction) {
  if (!correction.loop) {
    return std::nullopt;
  }
  const MapCorrection::LoopEdge edge{map.NearestAlive(correction.loop->a),
                                     map.NearestAlive(correction.loop->b)};
  const bool is_edge =
      edge.a != edge.b && map.keyframes().Contains(edge.a) && map.keyframes().Contains(edge.b);
  return is_edge ? std::optional(edge) : std::nullopt;
}

}  // namespace

CorrectionOutcome ApplyCorrection(Map& map, const MapCorrection& correction,
                                  const ScaleLevels& levels) {
  if (correction.snapshot_corrections != map.correction_count()) {
    return {};
  }
  const WorldChanges changes(map, correction);
  MoveObjects(map, changes);
  MoveKeyframes(map, correction, changes);
  MoveLandmarks(map, correction, changes, levels);
  const std::optional<MapCorrection::LoopEdge> loop = FindLoop(map, correction);
  if (loop) {
    JoinIslands(map, loop->a, loop->b);  // before they get landmarks in common
  }
  MergeLandmarks(map, correction, levels);
  CorrectionOutcome outcome;
  outcome.is_applied = true;
  outcome.merged_objects = MergeObjects(map, correction);
  if (loop) {
    map.AddLoop(loop->a, loop->b);
  }
  map.CountCorrection();
  return outcome;
}

MapCorrection ScalingOf(const Map& map, double factor) {
  MapCorrection correction;
  correction.snapshot_corrections = map.correction_count();
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    const Rigid3& pose = keyframe.cam_from_world;
    correction.poses.push_back({id, pose, Sim3(1.0 / factor, pose.rotation, pose.translation)});
  });
  return correction;
}

}  // namespace hullslam
