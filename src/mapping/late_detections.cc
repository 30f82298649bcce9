// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/late_detections.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "frame/rolling_shutter.h"
#include "map/compaction.h"
#include "map/islands.h"
#include "map/keyframe_order.h"
#include "objects/association.h"
#include "objects/object_index.h"

namespace hullslam {
namespace {

std::vector<uint32_t> AllOf(size_t count) {
  std::vector<uint32_t> indices(count);
  std::iota(indices.begin(), indices.end(), 0U);
  return indices;
}

// The indices of the keypoints that are not on things of the dynamic classes.
std::vector<uint32_t> StaticKeypoints(const LateDetections& late) {
  std::vector<uint32_t> kept;
  const std::vector<uint32_t> all = AllOf(late.keypoints);
  std::ranges::set_difference(all, late.dynamic_keypoints, std::back_inserter(kept));
  return kept;
}

size_t EraseDynamic(Map& map, const LateDetections& late, std::vector<LandmarkId> landmarks) {
  size_t erased = 0;
  for (const uint32_t keypoint : late.dynamic_keypoints) {
    const LandmarkId landmark = map.Resolve(landmarks.at(keypoint));
    if (landmark.IsValid()) {
      map.EraseLandmark(landmark);
      ++erased;
    }
  }
  return erased;
}

std::shared_ptr<const Frame> WithDetections(const Frame& frame, const Sensor& sensor,
                                            const LateDetections& late) {
  auto changed = std::make_shared<Frame>(frame);
  changed->detections = late.detections;
  if (changed->shutter != nullptr) {
    CorrectDetections(sensor, *changed->shutter, changed->detections);
    changed->shutter.reset();
  }
  return changed;
}

// Whether a keyframe with detections was taken less than `time` (s) before or after the frame.
bool IsNearDetections(const Map& map, const Frame& frame, IslandId island, double time) {
  for (const int step : {-1, 1}) {
    const Keyframe* keyframe = NextInTime(map, frame.id, island, step);
    while (keyframe != nullptr && std::abs(keyframe->frame->timestamp - frame.timestamp) < time) {
      if (!keyframe->frame->detections.empty()) {
        return true;
      }
      keyframe = NextInTime(map, keyframe->frame->id, island, step);
    }
  }
  return false;
}

// Whether a detection of the frame shows no mapped object.
bool ShowsUnknownObject(const Map& map, const Sensor& sensor, const ObjectOptions& objects,
                        const KeyframeRequest& request, IslandId island) {
  std::vector<LandmarkId> landmarks;
  std::ranges::transform(request.landmarks, std::back_inserter(landmarks),
                         [&](LandmarkId landmark) { return map.Resolve(landmark); });
  const ObjectIndex index(map, sensor.camera);
  const std::vector<ObjectId> shown =
      AssociateDetections({.map = map,
                           .index = index,
                           .sensor = sensor,
                           .frame = *request.frame,
                           .cam_from_world = map.CamFromWorld(request.pose),
                           .island = island,
                           .landmarks = landmarks,
                           .scope = AssociationScope::kMapped},
                          objects.association);
  return std::ranges::any_of(shown, [](ObjectId id) { return !id.IsValid(); });
}

// The request without the keypoints on things of the dynamic classes.
KeyframeRequest WithoutDynamic(KeyframeRequest request, const LateDetections& late) {
  const std::vector<uint32_t> kept = StaticKeypoints(late);
  request.frame = ReduceFrame(*request.frame, kept, AllOf(late.detections.size()));
  std::vector<LandmarkId> landmarks;
  std::ranges::transform(kept, std::back_inserter(landmarks),
                         [&](uint32_t keypoint) { return request.landmarks.at(keypoint); });
  request.landmarks = std::move(landmarks);
  return request;
}

}  // namespace

bool AddLateDetections(Map& map, const Sensor& sensor, KeyframeId id, const LateDetections& late) {
  Keyframe& keyframe = map.MutableKeyframe(id);
  if (!keyframe.frame->detections.empty() || keyframe.frame->features.size() != late.keypoints) {
    return false;
  }
  keyframe.frame = WithDetections(*keyframe.frame, sensor, late);
  keyframe.objects.assign(late.detections.size(), ObjectId());
  if (!late.dynamic_keypoints.empty()) {
    EraseDynamic(map, late, keyframe.landmarks);
    ReduceKeyframe(map, id, StaticKeypoints(late), AllOf(late.detections.size()));
  }
  return true;
}

size_t EraseDynamicLandmarks(Map& map, const LateDetections& late) {
  return late.request ? EraseDynamic(map, late, late.request->landmarks) : 0;
}

std::optional<KeyframeRequest> RequestLateKeyframe(const Map& map, const Sensor& sensor,
                                                   const ObjectOptions& objects,
                                                   const LateDetections& late,
                                                   RequestMemory& memory) {
  if (!late.request || late.detections.empty() ||
      !map.NearestAlive(late.request->pose.reference).IsValid()) {
    return std::nullopt;
  }
  KeyframeRequest request = *late.request;
  const IslandId island = IslandOf(map, request.pose.reference);
  // Time stamps are not exactly regular (KeyframePolicy::time_tolerance).
  const double time =
      ObjectRequestRule().TimeAfter(memory.CountFruitless(map)) - 0.5 / sensor.frames_per_second;
  if (IsNearDetections(map, *request.frame, island, time)) {
    return std::nullopt;
  }
  request.frame = WithDetections(*request.frame, sensor, late);
  if (!ShowsUnknownObject(map, sensor, objects, request, island)) {
    return std::nullopt;
  }
  memory.AddRequest();
  return late.dynamic_keypoints.empty() ? request : WithoutDynamic(std::move(request), late);
}

}  // namespace hullslam
