// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/compaction.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "frame/rolling_shutter.h"
#include "hullslam/util/check.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

template <typename Value>
std::vector<Value> Select(const std::vector<Value>& values, std::span<const uint32_t> indices) {
  std::vector<Value> selected;
  selected.reserve(indices.size());
  std::ranges::transform(indices, std::back_inserter(selected),
                         [&](uint32_t index) { return values.at(index); });
  return selected;
}

auto& ObservationBy(KeyframeId keyframe, auto& observations) {
  const auto it = std::ranges::find_if(
      observations, [&](const auto& observation) { return observation.keyframe == keyframe; });
  Check(it != observations.end(), "an observation that only the keyframe knows");
  return *it;
}

// The positions in `kept` of those `indices` that it contains. Both increase.
std::vector<uint32_t> PositionsIn(std::span<const uint32_t> kept,
                                  const std::vector<uint32_t>& indices) {
  std::vector<uint32_t> positions;
  for (const uint32_t index : indices) {
    const auto it = std::lower_bound(kept.begin(), kept.end(), index);
    if (it != kept.end() && *it == index) {
      positions.push_back(static_cast<uint32_t>(it - kept.begin()));
    }
  }
  positions.shrink_to_fit();
  return positions;
}

}  // namespace

void CompactKeyframe(Map& map, KeyframeId id) {
  const Keyframe& keyframe = map.keyframes().At(id);
  ReduceKeyframe(map, id, IndicesOfValid(keyframe.landmarks), IndicesOfValid(keyframe.objects));
}

void ReduceKeyframe(Map& map, KeyframeId id, std::span<const uint32_t> keypoints,
                    std::span<const uint32_t> detections) {
  Keyframe& keyframe = map.MutableKeyframe(id);
  map.ReplaceFrame(id, ReduceFrame(*keyframe.frame, keypoints, detections));
  keyframe.landmarks = Select(keyframe.landmarks, keypoints);
  keyframe.objects = Select(keyframe.objects, detections);
  keyframe.covisible.shrink_to_fit();
  for (uint32_t i = 0; i < keypoints.size(); ++i) {
    if (keypoints[i] != i && keyframe.landmarks[i].IsValid()) {
      ObservationBy(id, map.MutableLandmark(keyframe.landmarks[i]).observations).keypoint = i;
    }
  }
  for (uint32_t i = 0; i < detections.size(); ++i) {
    if (detections[i] != i && keyframe.objects[i].IsValid()) {
      ObservationBy(id, map.MutableObject(keyframe.objects[i]).observations).detection = i;
    }
  }
}

std::shared_ptr<const Frame> ReduceFrame(const Frame& frame, std::span<const uint32_t> keypoints,
                                         std::span<const uint32_t> detections) {
  auto reduced = std::make_shared<Frame>();
  reduced->id = frame.id;
  reduced->timestamp = frame.timestamp;
  reduced->motion = frame.motion;
  reduced->depth_delay = frame.depth_delay;
  reduced->features = SelectKeypoints(frame.features, keypoints);
  if (const std::vector<WordId>& words = frame.words.get(); !words.empty()) {
    reduced->words = Select(words, keypoints);
  }
  if (frame.shutter != nullptr) {
    auto shutter = std::make_shared<ShutterMotion>();
    shutter->velocity = frame.shutter->velocity;
    shutter->inverse_depths = Select(frame.shutter->inverse_depths, keypoints);
    shutter->depths = Select(frame.shutter->depths, keypoints);
    reduced->shutter = std::move(shutter);
  }
  reduced->detections.reserve(detections.size());
  for (const uint32_t index : detections) {
    Detection& detection = reduced->detections.emplace_back(frame.detections.at(index));
    detection.keypoints = PositionsIn(keypoints, detection.keypoints);
  }
  return reduced;
}

}  // namespace hullslam
