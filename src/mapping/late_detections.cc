// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/late_detections.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "frame/reduced_frame.h"
#include "map/compaction.h"

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

void EraseDynamicLandmarks(Map& map, const LateDetections& late,
                           std::vector<LandmarkId> landmarks) {
  for (const uint32_t keypoint : late.dynamic_keypoints) {
    const LandmarkId landmark = map.Resolve(landmarks.at(keypoint));
    if (landmark.IsValid()) {
      map.EraseLandmark(landmark);
    }
  }
}

std::shared_ptr<const Frame> WithDetections(const Frame& frame, const LateDetections& late) {
  auto changed = std::make_shared<Frame>(frame);
  changed->detections = late.detections;
  return changed;
}

}  // namespace

bool AddLateDetections(Map& map, KeyframeId id, const LateDetections& late) {
  Keyframe& keyframe = map.MutableKeyframe(id);
  if (!keyframe.frame->detections.empty() || keyframe.frame->features.size() != late.keypoints) {
    return false;
  }
  keyframe.frame = WithDetections(*keyframe.frame, late);
  keyframe.objects.assign(late.detections.size(), ObjectId());
  if (!late.dynamic_keypoints.empty()) {
    EraseDynamicLandmarks(map, late, keyframe.landmarks);
    ReduceKeyframe(map, id, StaticKeypoints(late), AllOf(late.detections.size()));
  }
  return true;
}

std::optional<KeyframeRequest> RequestLateKeyframe(Map& map, const LateDetections& late) {
  if (!late.request || late.detections.empty() ||
      !map.NearestAlive(late.request->pose.reference).IsValid()) {
    return std::nullopt;
  }
  KeyframeRequest request = *late.request;
  request.frame = WithDetections(*request.frame, late);
  if (!late.dynamic_keypoints.empty()) {
    EraseDynamicLandmarks(map, late, request.landmarks);
    const std::vector<uint32_t> kept = StaticKeypoints(late);
    request.frame = ReduceFrame(*request.frame, kept, AllOf(late.detections.size()));
    std::vector<LandmarkId> landmarks;
    std::ranges::transform(kept, std::back_inserter(landmarks),
                           [&](uint32_t keypoint) { return request.landmarks.at(keypoint); });
    request.landmarks = std::move(landmarks);
  }
  return request;
}

}  // namespace hullslam
