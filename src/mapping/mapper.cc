// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/mapper.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <variant>

#include "frame/measure_point.h"
#include "map/correction.h"
#include "map/islands.h"
#include "mapping/culling.h"
#include "mapping/keyframe_insertion.h"
#include "mapping/landmark_creation.h"
#include "mapping/late_detections.h"
#include "objects/object_extents.h"
#include "optim/bundle_adjustment.h"

namespace hullslam {
namespace {

// The scale of a monocular map is measured once objects of known size have this many observations.
constexpr size_t kMinSizedKeyframes = 10;
// Smaller changes of the scale wait for the end of the run, because every change invalidates a loop
// that is being computed.
constexpr double kScaleTolerance = 0.01;

size_t CountSizedKeyframes(const Map& map, const std::map<std::string, double>& sizes) {
  size_t views = 0;
  map.objects().ForEach([&](ObjectId, const ObjectLandmark& object) {
    views += KnownSize(object, sizes) > 0.0 ? object.observations.size() : 0;
  });
  return views;
}

std::vector<ObjectId> MappedObjects(const Map& map) {
  std::vector<ObjectId> mapped;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (object.state == ObjectState::kMapped) {
      mapped.push_back(id);
    }
  });
  return mapped;
}

}  // namespace

Mapper::Mapper(const Sensor& sensor, const MappingOptions& options, const ObjectOptions& objects,
               Publish publish, std::shared_ptr<const Vocabulary> vocabulary)
    : sensor_(sensor),
      wide_sensor_(WithWideErrors(sensor)),
      options_(options),
      object_options_(objects),
      publish_(std::move(publish)),
      object_mapper_(sensor, objects),
      map_(std::move(vocabulary)) {}

void Mapper::Begin(Map map, Session session) {
  session_ = std::move(session);
  if (!map.keyframes().empty()) {
    map_ = std::move(map);
    former_ = map_.Snapshot();
    object_mapper_.Keep(MappedObjects(former_));
    recent_ = FindRecentLandmarks(map_);
    PublishSnapshot();
  }
}

void Mapper::BeginSession() {
  if (session_) {
    map_.BeginSession(*std::exchange(session_, std::nullopt));
  }
}

bool Mapper::Process(const MapMessage& message, const Cancellation* hurry) {
  return std::visit([&](const auto& content) { return Apply(content, hurry); }, message);
}

bool Mapper::Apply(const InitialMap& initial, const Cancellation* hurry) {
  std::vector<KeyframeId> keyframes;
  {
    const ScopedTimer timer(times_, "map_insert");
    BeginSession();
    keyframes = InsertInitialMap(map_, initial, SensorNow(), recent_);
    PublishSnapshot();
  }
  for (const KeyframeId keyframe : keyframes) {
    AddEntities(keyframe, hurry);
  }
  Improve(keyframes.back(), hurry, Culling::kNone);
  full_.insert(full_.end(), keyframes.begin(), keyframes.end());
  PublishSnapshot();
  return true;
}

bool Mapper::Apply(const KeyframeRequest& request, const Cancellation* hurry) {
  wide_keyframes_ += has_wide_steps_ ? 1 : 0;
  KeyframeId keyframe;
  {
    const ScopedTimer timer(times_, "map_insert");
    BeginSession();
    visits_.Add(map_, request.sightings, request.frame->timestamp);
    keyframe = InsertKeyframe(map_, request, SensorNow(), recent_, options_.landmark_rule);
    map_.ForgetReplaced(request.oldest_revision);
    PublishSnapshot();
  }
  AddEntities(keyframe, hurry);
  Improve(keyframe, hurry, options_.cull_keyframes ? Culling::kKeyframes : Culling::kNone);
  if (options_.max_keyframes > 0) {
    const ScopedTimer timer(times_, "cull_keyframes");
    CullOverBound(map_, keyframe, sensor_, static_cast<size_t>(object_options_.start.min_views),
                  static_cast<size_t>(options_.max_keyframes));
  }
  full_.push_back(keyframe);
  if (options_.compact_keyframes) {
    const ScopedTimer timer(times_, "compact_keyframes");
    CompactOldKeyframes(map_, keyframe, full_);
  }
  FollowKnownSizes(false);
  PublishSnapshot();
  return true;
}

bool Mapper::Apply(const MapCorrection& correction, const Cancellation*) {
  const ScopedTimer timer(times_, "map_correction");
  const CorrectionOutcome outcome = ApplyCorrection(map_, correction, sensor_.levels);
  if (outcome.is_applied) {
    object_mapper_.RefineMerged(map_, outcome.merged_objects);
    PublishSnapshot();
  }
  return outcome.is_applied;
}

bool Mapper::Apply(const LateDetections& late, const Cancellation* hurry) {
  const std::optional<KeyframeId> keyframe = map_.KeyframeOfFrame(late.frame);
  if (keyframe && map_.keyframes().Contains(*keyframe)) {
    return AddLate(*keyframe, late);
  }
  std::optional<KeyframeRequest> request;
  {
    const ScopedTimer timer(times_, "map_objects");
    if (EraseDynamicLandmarks(map_, late) > 0) {
      PublishSnapshot();
    }
    if (!keyframe && object_options_.enabled) {
      request = RequestLateKeyframe(map_, sensor_, object_options_, late, late_requests_);
    }
  }
  return request && Apply(*request, hurry);
}

bool Mapper::Apply(const ObjectEdit& edit, const Cancellation*) {
  const ObjectId id = map_.Resolve(edit.object);
  if (!id.IsValid()) {
    return false;
  }
  ObjectLandmark& object = map_.MutableObject(id);
  object.name = edit.name.value_or(object.name);
  object.is_locked = edit.is_locked.value_or(object.is_locked);
  object.known_size = edit.known_size.value_or(object.known_size);
  if (edit.is_deleted) {
    map_.EraseObject(id);
  }
  PublishSnapshot();
  if (edit.known_size) {
    sized_keyframes_ = 0;
    FollowKnownSizes(session_.has_value());  // a loaded map may get no keyframes
  }
  return true;
}

bool Mapper::AddLate(KeyframeId keyframe, const LateDetections& late) {
  if (!AddLateDetections(map_, sensor_, keyframe, late)) {
    return false;
  }
  if (object_options_.enabled) {
    const ScopedTimer timer(times_, "map_objects");
    object_mapper_.Process(map_, keyframe);
  }
  PublishSnapshot();
  return true;
}

// Creates the landmarks and objects that follow from a new keyframe.
void Mapper::AddEntities(KeyframeId keyframe, const Cancellation* hurry) {
  newest_keyframe_ = keyframe;
  {
    const ScopedTimer timer(times_, "map_landmarks");
    if (has_wide_steps_) {
      recent_.clear();
    } else {
      CullRecentLandmarks(map_, keyframe, sensor_, recent_);
    }
    const std::vector<LandmarkId> created =
        CreateLandmarks(map_, keyframe, SensorNow(), options_.landmark_rule);
    recent_.insert(recent_.end(), created.begin(), created.end());
    if (!IsRequested(hurry)) {
      FuseLandmarks(map_, keyframe, SensorNow());
    }
    contradicted_landmarks_ += EraseContradictedLandmarks(map_, keyframe, sensor_, contradictions_);
    EraseForgottenLandmarks(map_, keyframe, sensor_, visits_);
  }
  MapObjects(keyframe);
}

void Mapper::Improve(KeyframeId keyframe, const Cancellation* hurry, Culling culling) {
  if (IsRequested(hurry) || map_.keyframes().size() <= 2) {
    return;
  }
  AdjustNeighbourhood(keyframe, hurry);
  if (culling == Culling::kKeyframes) {
    const ScopedTimer timer(times_, "cull_keyframes");
    CullKeyframes(map_, keyframe, sensor_, static_cast<size_t>(object_options_.start.min_views),
                  options_.culling_rule);
  }
}

std::optional<KeyframeId> Mapper::NewestKeyframe() const {
  return map_.keyframes().Contains(newest_keyframe_) ? std::optional(newest_keyframe_)
                                                     : std::nullopt;
}

void Mapper::MapObjects(KeyframeId keyframe) {
  const bool has_detections = !map_.keyframes().At(keyframe).frame->detections.empty();
  const bool has_objects = has_detections || (!awaits_masks_ && !map_.objects().empty());
  if (object_options_.enabled && has_objects) {
    const ScopedTimer timer(times_, "map_objects");
    object_mapper_.Process(map_, keyframe);
  }
}

void Mapper::PublishSnapshot() {
  std::shared_ptr<const Map> snapshot;
  {
    const ScopedTimer timer(times_, "map_snapshot");
    snapshot = std::make_shared<const Map>(map_.Snapshot());
  }
  publish_(std::move(snapshot));
}

void Mapper::AdjustNeighbourhood(KeyframeId keyframe, const Cancellation* hurry) {
  BundleWindow window;
  {
    const ScopedTimer timer(times_, "local_bundle_adjustment");
    window = LocalWindow(map_, keyframe, static_cast<size_t>(options_.local_keyframes),
                         static_cast<size_t>(options_.fixed_keyframes),
                         ObjectsToAdjust(object_options_));
    Apply(AdjustBundle(map_, SensorNow(), window, {.objects = object_options_.bundle}, hurry));
  }
  RecheckObjects(window.objects);
}

void Mapper::SplitIslands(const Cancellation* cancellation) {
  const IslandId main = MainIsland(map_);
  for (const IslandId island : Islands(map_)) {
    if (island == main) {
      continue;
    }
    Map left = map_.Snapshot();
    KeepOnlyIsland(left, island);
    if (options_.final_bundle_adjustment && !IsRequested(cancellation) &&
        left.keyframes().size() >= 2) {
      const ScopedTimer timer(times_, "global_bundle_adjustment");
      const BundleResult result =
          AdjustIsland(left, island, SensorOfRun(), object_options_, cancellation).result;
      if (result.is_usable) {
        ApplyBundle(left, result, sensor_.levels);
      }
    }
    left_islands_.push_back(std::make_shared<const Map>(std::move(left)));
  }
  if (KeepOnlyIsland(map_, main)) {
    PublishSnapshot();
  }
}

void Mapper::AdjustMap(const Cancellation* cancellation, const ProgressCallback& on_progress) {
  if (!options_.final_bundle_adjustment || IsRequested(cancellation) ||
      map_.keyframes().size() < 2) {
    return;
  }
  IslandAdjustment adjustment;
  {
    const ScopedTimer timer(times_, "global_bundle_adjustment");
    adjustment = AdjustIsland(map_, MainIsland(map_), SensorOfRun(), object_options_, cancellation,
                              on_progress);
    Apply(adjustment.result);
  }
  RecheckObjects(adjustment.objects);
  PublishSnapshot();
}

void Mapper::FinishObjects() {
  if (!object_options_.enabled || former_.objects().empty()) {
    return;
  }
  {
    const ScopedTimer timer(times_, "object_changes");
    object_changes_ = FindChanges({});
    if (const std::set<ObjectId> replaced = SplitReplacedObjects(); !replaced.empty()) {
      object_changes_ = FindChanges(replaced);
    }
    for (const ChangedObject& changed : object_changes_) {
      if (const ObjectId id = FindLeft(changed); id.IsValid()) {
        map_.EraseObject(id);
      }
    }
  }
  PublishSnapshot();
}

std::vector<ChangedObject> Mapper::FindChanges(const std::set<ObjectId>& left) const {
  return FindObjectChanges(former_, map_, former_.NextFrame(), sensor_, object_options_, left);
}

// The object of the map that is gone or was moved away; invalid if the change is another one or if
// the object was removed already.
ObjectId Mapper::FindLeft(const ChangedObject& changed) const {
  const bool has_left =
      changed.change == ObjectChange::kGone || changed.change == ObjectChange::kMoved;
  const ObjectId id = has_left ? map_.Resolve(changed.former->object) : ObjectId();
  return map_.objects().Contains(id) ? id : ObjectId();
}

// Splits off new objects that took the location of old ones. Returns the ids of the old ones in the
// former map.
std::set<ObjectId> Mapper::SplitReplacedObjects() {
  std::set<ObjectId> replaced;
  for (const ChangedObject& changed : object_changes_) {
    if (const ObjectId id = FindLeft(changed); id.IsValid()) {
      const ObjectId former = changed.former->object;
      if (object_mapper_.SplitOff(map_, id, former_.objects().At(former), former_.NextFrame())) {
        replaced.insert(former);
      }
    }
  }
  return replaced;
}

// Makes the unit of length of a monocular map the metre if objects of known size are mapped. During
// the run this is done once they have been seen often enough, and again when they have been seen
// twice as often.
void Mapper::FollowKnownSizes(bool is_final) {
  const std::map<std::string, double>& sizes = object_options_.sizes;
  if (!sensor_.IsMonocular() || !object_options_.enabled) {
    return;
  }
  const size_t views = CountSizedKeyframes(map_, sizes);
  const bool is_due = is_final || views >= std::max(kMinSizedKeyframes, 2 * sized_keyframes_);
  if (views == 0 || !is_due || Islands(map_).size() != 1) {
    return;  // each island has its own unit of length
  }
  const ScopedTimer timer(times_, "known_sizes");
  sized_keyframes_ = views;
  const KnownScale scale = MeasureScale(map_, sensor_, sizes);
  const double tolerance = is_final ? 0.0 : kScaleTolerance;
  if (std::abs(std::log(scale.metres_per_unit)) > tolerance) {
    ApplyCorrection(map_, ScalingOf(map_, scale.metres_per_unit), sensor_.levels);
    PublishSnapshot();
  }
}

void Mapper::Apply(const BundleResult& result) {
  if (result.is_usable) {
    ApplyBundle(map_, result, sensor_.levels);
  }
}

void Mapper::RecheckObjects(const std::vector<ObjectId>& objects) {
  if (!objects.empty()) {
    const ScopedTimer timer(times_, "check_objects");
    object_mapper_.Recheck(map_, objects);
  }
}

}  // namespace hullslam
