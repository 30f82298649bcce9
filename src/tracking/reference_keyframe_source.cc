// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/by_descriptor.h"
#include "tracking/pose_refinement.h"
#include "tracking/pose_source.h"

namespace hullslam {

std::optional<PoseEstimate> PoseByReferenceKeyframe(const Frame& frame, const Map& map,
                                                    const TrackingContext& context,
                                                    const LastFrame& last) {
  if (last.frame == nullptr) {
    return std::nullopt;
  }
  const Keyframe& reference = map.keyframes().At(last.reference);
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < reference.landmarks.size(); ++i) {
    if (reference.landmarks[i].IsValid()) {
      indices.push_back(i);
    }
  }
  const std::vector<Match> matches =
      MatchByDescriptor(reference.frame->features, indices, frame.features, {});
  if (matches.size() < context.min_reference_matches()) {
    return std::nullopt;
  }
  PoseEstimate estimate;
  estimate.cam_from_world = last.cam_from_world;
  estimate.landmarks.resize(frame.features.size());
  for (const Match& match : matches) {
    estimate.landmarks[match.keypoint] = reference.landmarks[match.query];
  }
  estimate = RefinePose(frame, map, context, {}, std::move(estimate));
  return estimate.inliers >= context.min_start_inliers() ? std::optional(std::move(estimate))
                                                         : std::nullopt;
}

}  // namespace hullslam
