// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/culling.h"

#include <algorithm>

namespace hullslam {
namespace {

constexpr double kMinFoundRatio = 0.25;
constexpr uint32_t kTrialKeyframes = 2;  // later a small weight is a reason to erase
constexpr int kMaxWeakWeight = 3;
constexpr int kOtherObservers = 3;
constexpr double kRedundantShare = 0.9;

bool IsSeenByOthers(const Map& map, const Landmark& landmark, KeyframeId id, int level) {
  int others = 0;
  for (const Observation& observation : landmark.observations) {
    if (observation.keyframe == id) {
      continue;
    }
    const Frame& frame = *map.keyframes().At(observation.keyframe).frame;
    if (frame.features.keypoints[observation.keypoint].level <= level + 1 &&
        ++others >= kOtherObservers) {
      return true;
    }
  }
  return false;
}

bool IsRedundant(const Map& map, KeyframeId id, const Sensor& sensor) {
  const Keyframe& keyframe = map.keyframes().At(id);
  const FrameFeatures& features = keyframe.frame->features;
  int close = 0;
  int redundant = 0;
  for (size_t i = 0; i < keyframe.landmarks.size(); ++i) {
    const double depth = static_cast<double>(features.depth[i]);
    if (!keyframe.landmarks[i].IsValid() || depth <= 0.0 || depth > sensor.close_depth) {
      continue;
    }
    ++close;
    const Landmark& landmark = map.landmarks().At(keyframe.landmarks[i]);
    redundant += IsSeenByOthers(map, landmark, id, features.keypoints[i].level) ? 1 : 0;
  }
  return redundant > kRedundantShare * close;
}

}  // namespace

void CullRecentLandmarks(Map& map, KeyframeId current, std::vector<LandmarkId>& recent) {
  std::erase_if(recent, [&](LandmarkId id) {
    const Landmark* landmark = map.landmarks().Find(id);
    if (landmark == nullptr) {
      return true;
    }
    const uint32_t age = current.value - landmark->created_by.value;
    const bool is_seldom_found = landmark->found < kMinFoundRatio * landmark->visible;
    const bool is_weak = age >= kTrialKeyframes && landmark->observation_weight <= kMaxWeakWeight;
    if (is_seldom_found || is_weak) {
      map.EraseLandmark(id);
      return true;
    }
    return age > kTrialKeyframes;
  });
}

int CullKeyframes(Map& map, KeyframeId current, const Sensor& sensor) {
  int culled = 0;
  const std::vector<Covisible> candidates = map.keyframes().At(current).covisible;
  for (const Covisible& candidate : candidates) {
    const Keyframe* keyframe = map.keyframes().Find(candidate.keyframe);
    const bool is_root = keyframe == nullptr || !keyframe->parent.IsValid();
    if (!is_root && IsRedundant(map, candidate.keyframe, sensor)) {
      map.CullKeyframe(candidate.keyframe);
      ++culled;
    }
  }
  return culled;
}

}  // namespace hullslam
