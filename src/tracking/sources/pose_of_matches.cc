// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sources/pose_of_matches.h"

#include <utility>
#include <vector>

#include "estimators/absolute_pose.h"
#include "frame/measure_point.h"
#include "util/hash.h"

namespace hullslam {

std::optional<PoseEstimate> PoseOfMatches(const Frame& frame, const Map& map,
                                          const TrackingContext& context,
                                          std::span<const FoundLandmark> matches,
                                          size_t min_inliers, std::string_view purpose) {
  std::vector<PoseObservation> observations;
  observations.reserve(matches.size());
  for (const auto& [keypoint, landmark] : matches) {
    observations.push_back({.point = map.landmarks().At(landmark).position,
                            .measurement = MeasurePoint(context.sensor, frame.features, keypoint,
                                                        context.sensor.depth_error)});
  }
  RansacOptions ransac;
  ransac.seed = HashSeed(context.seed, frame.id.value, purpose);
  ransac.min_inliers = min_inliers;
  const AbsolutePose pose = EstimateAbsolutePose(context.sensor.camera, observations, ransac);
  if (!pose.ok()) {
    return std::nullopt;
  }
  PoseEstimate estimate;
  estimate.cam_from_world = pose.cam_from_world;
  estimate.landmarks.resize(frame.features.size());
  for (const size_t inlier : pose.inliers) {
    estimate.landmarks[matches[inlier].keypoint] = matches[inlier].landmark;
  }
  return RefinePose(frame, map, context, {}, std::move(estimate));
}

}  // namespace hullslam
