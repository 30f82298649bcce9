// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/compaction.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

#include "frame/reduced_frame.h"
#include "hullslam/util/check.h"
#include "util/valid_ids.h"

namespace hullslam {
namespace {

template <typename IdType>
std::vector<IdType> ValidOnes(const std::vector<IdType>& ids) {
  std::vector<IdType> valid;
  valid.reserve(static_cast<size_t>(
      std::count_if(ids.begin(), ids.end(), [](IdType id) { return id.IsValid(); })));
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(valid),
               [](IdType id) { return id.IsValid(); });
  return valid;
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
  Keyframe& keyframe = map.MutableKeyframe(id);
  const std::vector<uint32_t> keypoints = IndicesOfValid(keyframe.landmarks);
  const std::vector<uint32_t> detections = IndicesOfValid(keyframe.objects);
  map.ReplaceFrame(id, ReduceFrame(*keyframe.frame, keypoints, detections));
  keyframe.landmarks = ValidOnes(keyframe.landmarks);
  keyframe.objects = ValidOnes(keyframe.objects);
  keyframe.covisible.shrink_to_fit();
  for (uint32_t i = 0; i < keypoints.size(); ++i) {
    if (keypoints[i] != i) {
      ObservationBy(id, map.MutableLandmark(keyframe.landmarks[i]).observations).keypoint = i;
    }
  }
  for (uint32_t i = 0; i < detections.size(); ++i) {
    if (detections[i] != i) {
      ObservationBy(id, map.MutableObject(keyframe.objects[i]).observations).detection = i;
    }
  }
}

}  // namespace hullslam
