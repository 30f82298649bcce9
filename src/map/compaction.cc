// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/compaction.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

#include "frame/reduced_frame.h"
#include "hullslam/util/check.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

template <typename IdType>
std::vector<IdType> Select(const std::vector<IdType>& ids, std::span<const uint32_t> indices) {
  std::vector<IdType> selected;
  selected.reserve(indices.size());
  std::ranges::transform(indices, std::back_inserter(selected),
                         [&](uint32_t index) { return ids.at(index); });
  return selected;
}

auto& ObservationBy(KeyframeId keyframe, auto& observations) {
  const auto it =
      std::find_if(observations.begin(), observations.end(),
                   [&](const auto& observation) { return observation.keyframe == keyframe; });
  Check(it != observations.end(), "an observation that only the keyframe knows");
  return *it;
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

}  // namespace hullslam
