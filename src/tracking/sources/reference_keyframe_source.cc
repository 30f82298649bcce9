// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "matching/by_descriptor.h"
#include "places/landmark_search.h"
#include "tracking/pose_refinement.h"
#include "tracking/sources/confirmed_pose.h"
#include "tracking/sources/pose_source.h"

namespace hullslam {
namespace {

// Matches keypoints without a prediction of their pixels. Words save most comparisons.
std::vector<FoundLandmark> FindByDescriptor(const Map& map, const Frame& frame, KeyframeId id) {
  if (map.vocabulary() != nullptr && !frame.words.is_absent()) {
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
  // From a last pose that is far off, the refinement can end where only a few matches agree by
  // chance. A pose with most of the matches cannot be beaten by another one.
  if (2 * static_cast<size_t>(estimate.inliers) < found.size()) {
    std::optional<PoseEstimate> agreed = PoseOfMatches(
        frame, map, context, found, context.min_reference_matches(), "reference keyframe");
    if (agreed && agreed->inliers > estimate.inliers) {
      estimate = std::move(*agreed);
    }
  }
  return estimate.inliers >= context.min_start_inliers() ? std::optional(std::move(estimate))
                                                         : std::nullopt;
}

}  // namespace hullslam
