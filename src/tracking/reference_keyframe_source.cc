// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/by_descriptor.h"
#include "places/landmark_search.h"
#include "tracking/pose_refinement.h"
#include "tracking/pose_source.h"

namespace hullslam {
namespace {

// Matches keypoints without a prediction of their pixels. Words save most comparisons.
std::vector<FoundLandmark> FindByDescriptor(const Map& map, const Frame& frame, KeyframeId id) {
  if (map.vocabulary() != nullptr && !frame.words.empty()) {
    return MatchLandmarksByWords(map, frame, id, {});
  }
  const Keyframe& keyframe = map.keyframes().At(id);
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (keyframe.landmarks[i].IsValid()) {
      indices.push_back(i);
    }
  }
  std::vector<FoundLandmark> found;
  for (const Match& match :
       MatchByDescriptor(keyframe.frame->features, indices, frame.features, {})) {
    found.push_back({match.keypoint, keyframe.landmarks[match.query]});
  }
  return found;
}

}  // namespace

std::optional<PoseEstimate> PoseByReferenceKeyframe(const Frame& frame, const Map& map,
                                                    const TrackingContext& context,
                                                    const LastFrame& last) {
  if (last.frame == nullptr) {
    return std::nullopt;
  }
  const std::vector<FoundLandmark> found = FindByDescriptor(map, frame, last.reference);
  if (found.size() < context.min_reference_matches()) {
    return std::nullopt;
  }
  PoseEstimate estimate;
  estimate.cam_from_world = last.cam_from_world;
  estimate.landmarks.resize(frame.features.size());
  for (const auto& [keypoint, landmark] : found) {
    estimate.landmarks[keypoint] = landmark;
  }
  estimate = RefinePose(frame, map, context, {}, std::move(estimate));
  return estimate.inliers >= context.min_start_inliers() ? std::optional(std::move(estimate))
                                                         : std::nullopt;
}

}  // namespace hullslam
