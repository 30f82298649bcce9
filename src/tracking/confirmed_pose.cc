// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/confirmed_pose.h"

#include <utility>

namespace hullslam {

std::optional<ConfirmedPose> FindConfirmedPose(const Frame& frame, const Map& map,
                                               const TrackingContext& context,
                                               const LastFrame& last,
                                               std::span<PoseSource* const> sources) {
  for (size_t i = 0; i < sources.size(); ++i) {
    std::optional<PoseEstimate> start = sources[i](frame, map, context, last);
    if (!start) {
      continue;
    }
    const KeyframeId near =
        start->keyframe_of_place.IsValid() ? start->keyframe_of_place : last.reference;
    LocalTracking tracking = TrackLocalMap(frame, map, context, near, std::move(*start));
    if (tracking.estimate.EffectiveInliers() >= context.options.min_inliers) {
      return ConfirmedPose{std::move(tracking), i};
    }
  }
  return std::nullopt;
}

}  // namespace hullslam
