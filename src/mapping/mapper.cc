// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/mapper.h"

#include <utility>
#include <variant>

#include "map/correction.h"
#include "mapping/culling.h"
#include "mapping/keyframe_insertion.h"
#include "mapping/landmark_creation.h"
#include "mapping/landmark_fusion.h"
#include "mapping/old_keyframes.h"

namespace hullslam {
namespace {

// A step that changes the cost by less than the tolerance is not taken. In a global adjustment the
// terms that correct drift are a small share of the cost, so the tolerance must be small.
BundleOptions ForWholeMap(BundleOptions options) {
  options.robust_iterations = 10;
  options.final_iterations = 20;
  options.function_tolerance = 1e-6;
  return options;
}

}  // namespace

Mapper::Mapper(const Sensor& sensor, const MappingOptions& options, const ObjectOptions& objects,
               Publish publish)
    : sensor_(sensor),
      options_(options),
      object_options_(objects),
      publish_(std::move(publish)),
      object_mapper_(sensor, objects) {}

void Mapper::Process(const MapMessage& message, const Cancellation* hurry) {
  std::visit([&](const auto& content) { Apply(content, hurry); }, message);
}

void Mapper::Apply(const InitialMap& initial, const Cancellation* hurry) {
  std::vector<KeyframeId> keyframes;
  {
    const ScopedTimer timer(times_, "map_insert");
    keyframes = InsertInitialMap(map_, initial, sensor_, recent_);
    PublishSnapshot();
  }
  for (const KeyframeId keyframe : keyframes) {
    ExtendMap(keyframe, hurry);
  }
}

void Mapper::Apply(const KeyframeRequest& request, const Cancellation* hurry) {
  KeyframeId keyframe;
  {
    const ScopedTimer timer(times_, "map_insert");
    keyframe = InsertKeyframe(map_, request, sensor_, recent_);
    map_.ForgetReplaced(request.oldest_revision);
    PublishSnapshot();
  }
  ExtendMap(keyframe, hurry);
}

void Mapper::Apply(const MapCorrection& correction, const Cancellation*) {
  const ScopedTimer timer(times_, "map_correction");
  const CorrectionOutcome outcome = ApplyCorrection(map_, correction, sensor_.levels);
  if (outcome.is_applied) {
    object_mapper_.RefineMerged(map_, outcome.merged_objects);
    PublishSnapshot();
  }
}

// Everything that follows from a new keyframe.
void Mapper::ExtendMap(KeyframeId keyframe, const Cancellation* hurry) {
  const auto must_hurry = [&] { return hurry != nullptr && hurry->IsRequested(); };
  {
    const ScopedTimer timer(times_, "map_landmarks");
    CullRecentLandmarks(map_, keyframe, recent_);
    const std::vector<LandmarkId> created = CreateLandmarks(map_, keyframe, sensor_);
    recent_.insert(recent_.end(), created.begin(), created.end());
    if (!must_hurry()) {
      FuseLandmarks(map_, keyframe, sensor_);
    }
  }
  MapObjects(keyframe);
  if (!must_hurry() && map_.keyframes().size() > 2) {
    AdjustNeighbourhood(keyframe, hurry);
    if (options_.cull_keyframes) {
      const ScopedTimer timer(times_, "cull_keyframes");
      CullKeyframes(map_, keyframe, sensor_, static_cast<size_t>(object_options_.start.min_views));
    }
  }
  full_.push_back(keyframe);
  if (options_.compact_keyframes) {
    const ScopedTimer timer(times_, "compact_keyframes");
    CompactOldKeyframes(map_, keyframe, full_);
  }
  PublishSnapshot();
}

void Mapper::MapObjects(KeyframeId keyframe) {
  const bool has_objects =
      !map_.objects().empty() || !map_.keyframes().At(keyframe).frame->detections.empty();
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
                         static_cast<size_t>(options_.fixed_keyframes), ObjectsToAdjust());
    Adjust(window, {.objects = object_options_.bundle}, hurry);
  }
  RecheckObjects(window.objects);
}

void Mapper::Finish(const Cancellation* cancellation, const ProgressCallback& on_progress) {
  const bool is_cancelled = cancellation != nullptr && cancellation->IsRequested();
  if (!options_.final_bundle_adjustment || is_cancelled || map_.keyframes().size() < 2) {
    return;
  }
  BundleWindow window;
  {
    const ScopedTimer timer(times_, "global_bundle_adjustment");
    window = GlobalWindow(map_, ObjectsToAdjust());
    Adjust(window, ForWholeMap({.objects = object_options_.bundle}), cancellation, on_progress);
  }
  RecheckObjects(window.objects);
  PublishSnapshot();
}

void Mapper::Adjust(const BundleWindow& window, const BundleOptions& options,
                    const Cancellation* cancellation, const ProgressCallback& on_progress) {
  const BundleResult result =
      AdjustBundle(map_, sensor_, window, options, cancellation, on_progress);
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

WindowObjects Mapper::ObjectsToAdjust() const {
  return object_options_.enabled && object_options_.bundle_adjustment ? WindowObjects::kMapped
                                                                      : WindowObjects::kNone;
}

}  // namespace hullslam
