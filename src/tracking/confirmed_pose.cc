// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/confirmed_pose.h"

#include <algorithm>
#include <utility>

namespace hullslam {
namespace {

// The landmarks of the local map are searched within kLocalSearchRadius of where the pose places
// them. If a pose may place them further off than that, by three standard deviations, those that
// are found elsewhere in the image do not confirm it, and the next frame begins at a wrong place.
constexpr double kMostCornerSigma = kLocalSearchRadius / 3.0;

}  // namespace

PoseSearch FindConfirmedPose(const Frame& frame, const Map& map, const TrackingContext& context,
                             const LastFrame& last, std::span<PoseSource* const> sources) {
  PoseSearch search;
  int most = 0;
  for (size_t i = 0; i < sources.size(); ++i) {
    if (search.found && !BeginsAtLastFrame(sources[i])) {
      break;
    }
    std::optional<PoseEstimate> start = sources[i](frame, map, context, last);
    if (!start) {
      continue;
    }
    const bool is_certain = start->EffectiveInliers() >= context.min_relocalisation_inliers();
    const KeyframeId near =
        start->keyframe_of_place.IsValid() ? start->keyframe_of_place : last.reference;
    LocalTracking tracking = TrackLocalMap(frame, map, context, near, std::move(*start));
    const int inliers = tracking.estimate.EffectiveInliers();
    if (inliers < context.options.min_inliers ||
        tracking.estimate.corner_sigma > kMostCornerSigma) {
      search.most_unconfirmed = std::max(search.most_unconfirmed, inliers);
      continue;
    }
    if (inliers > most) {
      most = inliers;
      search.found = ConfirmedPose{std::move(tracking), i};
    }
    if (is_certain) {
      break;
    }
  }
  return search;
}

}  // namespace hullslam
