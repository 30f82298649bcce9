// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/mapping/mapper.h"

#include <utility>

#include "hullslam/mapping/culling.h"
#include "hullslam/mapping/keyframe_insertion.h"
#include "hullslam/mapping/landmark_creation.h"
#include "hullslam/mapping/landmark_fusion.h"
#include "hullslam/optim/bundle_adjustment.h"

namespace hullslam {

Mapper::Mapper(const Sensor& sensor, const MappingOptions& options, Publish publish)
    : sensor_(sensor), options_(options), publish_(std::move(publish)) {}

void Mapper::Process(const KeyframeRequest& request, const Cancellation* hurry) {
  const auto must_hurry = [&] { return hurry != nullptr && hurry->IsRequested(); };
  KeyframeId keyframe;
  {
    const ScopedTimer timer(times_, "map_insert");
    keyframe = InsertKeyframe(map_, request, sensor_, recent_);
    PublishSnapshot();
  }
  {
    const ScopedTimer timer(times_, "map_landmarks");
    CullRecentLandmarks(map_, keyframe, recent_);
    const std::vector<LandmarkId> created = CreateLandmarks(map_, keyframe, sensor_);
    recent_.insert(recent_.end(), created.begin(), created.end());
    if (!must_hurry()) {
      FuseLandmarks(map_, keyframe, sensor_);
    }
  }
  if (!must_hurry() && map_.keyframes().size() > 2) {
    AdjustNeighbourhood(keyframe, hurry);
    if (options_.cull_keyframes) {
      const ScopedTimer timer(times_, "cull_keyframes");
      CullKeyframes(map_, keyframe, sensor_);
    }
  }
  PublishSnapshot();
}

void Mapper::PublishSnapshot() { publish_(std::make_shared<const Map>(map_.Snapshot())); }

void Mapper::AdjustNeighbourhood(KeyframeId keyframe, const Cancellation* hurry) {
  const ScopedTimer timer(times_, "local_bundle_adjustment");
  const BundleWindow window =
      LocalWindow(map_, keyframe, static_cast<size_t>(options_.local_keyframes),
                  static_cast<size_t>(options_.fixed_keyframes));
  const BundleResult result = AdjustBundle(map_, sensor_, window, {}, hurry);
  if (result.is_usable) {
    ApplyBundle(map_, result, sensor_.levels);
  }
}

}  // namespace hullslam
