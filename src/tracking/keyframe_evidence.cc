// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/keyframe_evidence.h"

#include <algorithm>
#include <span>
#include <vector>

#include "map/islands.h"

namespace hullslam {
namespace {

int CountCloseKeypoints(const Frame& frame, const Sensor& sensor,
                        const std::vector<LandmarkId>& landmarks, bool tracked) {
  int count = 0;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    const double depth = static_cast<double>(frame.features.depth[i]);
    const bool is_close = depth > 0.0 && depth < sensor.close_depth;
    count += is_close && landmarks[i].IsValid() == tracked ? 1 : 0;
  }
  return count;
}

// The number of those of the landmarks that have a sufficient observation weight. They are in the
// island of the keyframe `reference`.
int CountConfirmedLandmarks(const Map& map, KeyframeId reference,
                            std::span<const LandmarkId> landmarks) {
  const int min_weight = map.IslandSize(IslandOf(map, reference)) <= 2 ? 2 : 3;
  return static_cast<int>(std::count_if(landmarks.begin(), landmarks.end(), [&](LandmarkId id) {
    return id.IsValid() && map.landmarks().At(id).observation_weight >= min_weight;
  }));
}

}  // namespace

int CountConfirmed(const Map& map, KeyframeId reference, const PoseEstimate& estimate) {
  return CountConfirmedLandmarks(map, reference, estimate.landmarks) + estimate.EffectiveInliers() -
         estimate.inliers;
}

KeyframeEvidence GatherEvidence(const Frame& frame, const Map& map, const Sensor& sensor,
                                const LocalTracking& tracking, const LastFrame& last) {
  const PoseEstimate& estimate = tracking.estimate;
  return {
      .inliers = estimate.inliers,
      .confirmed_inliers = CountConfirmed(map, tracking.reference, estimate),
      .reference_landmarks = CountConfirmedLandmarks(
          map, tracking.reference, map.keyframes().At(tracking.reference).landmarks),
      .close_tracked = CountCloseKeypoints(frame, sensor, estimate.landmarks, true),
      .close_untracked = CountCloseKeypoints(frame, sensor, estimate.landmarks, false),
      .unknown_objects = tracking.unknown_objects,
      .next_overlap = NextOverlap(map, sensor, estimate.cam_from_world, tracking.reference, last),
      .keyframes = map.IslandSize(IslandOf(map, tracking.reference))};
}

}  // namespace hullslam
