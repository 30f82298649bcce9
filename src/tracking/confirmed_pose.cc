// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/confirmed_pose.h"

#include <algorithm>
#include <utility>

namespace hullslam {

PoseSearch FindConfirmedPose(const Frame& frame, const Map& map, const TrackingContext& context,
                             const LastFrame& last, std::span<PoseSource* const> sources) {
  PoseSearch search;
  for (size_t i = 0; i < sources.size(); ++i) {
    std::optional<PoseEstimate> start = sources[i](frame, map, context, last);
    if (!start) {
      continue;
    }
    const KeyframeId near =
        start->keyframe_of_place.IsValid() ? start->keyframe_of_place : last.reference;
    LocalTracking tracking = TrackLocalMap(frame, map, context, near, std::move(*start));
    const int inliers = tracking.estimate.EffectiveInliers();
    if (inliers >= context.options.min_inliers) {
      search.found = ConfirmedPose{std::move(tracking), i};
      return search;
    }
    search.most_unconfirmed = std::max(search.most_unconfirmed, inliers);
  }
  return search;
}

}  // namespace hullslam
