// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/relocaliser.h"

#include <array>
#include <utility>

#include "hullslam/util/check.h"
#include "objects/object_index.h"
#include "system/make_sensor.h"
#include "tracking/sources/confirmed_pose.h"

namespace hullslam {
namespace {

std::shared_ptr<const Map> NotNull(std::shared_ptr<const Map> map) {
  Check(map != nullptr, "relocalisation needs a map");
  return map;
}

}  // namespace

const char* ToString(RelocalisationMethod method) {
  return method == RelocalisationMethod::kWords ? "words" : "objects";
}

Relocaliser::Relocaliser(const SystemOptions& options, std::shared_ptr<const Map> map)
    : options_(options),
      map_(NotNull(std::move(map))),
      sensor_(std::make_unique<const Sensor>(MakeSensor(options_))),
      object_index_(std::make_unique<const ObjectIndex>(*map_, sensor_->camera)) {}

Relocaliser::~Relocaliser() = default;

std::optional<RelocalisedPose> Relocaliser::Find(const Frame& frame) const {
  if (map_->keyframes().empty()) {
    return std::nullopt;
  }
  const TrackingContext context{*sensor_, options_.tracking, options_.objects, *object_index_,
                                options_.seed};
  const std::optional<ConfirmedPose> found =
      FindConfirmedPose(frame, *map_, context, LastFrame(), kRelocalisationSources).found;
  if (!found) {
    return std::nullopt;
  }
  const PoseEstimate& estimate = found->tracking.estimate;
  constexpr std::array kMethods = {RelocalisationMethod::kWords, RelocalisationMethod::kObjects};
  static_assert(kMethods.size() == kRelocalisationSources.size());
  return RelocalisedPose{.cam_from_world = estimate.cam_from_world,
                         .method = kMethods[found->source],
                         .inliers = estimate.inliers,
                         .used_objects = estimate.used_objects};
}

}  // namespace hullslam
