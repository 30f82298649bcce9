// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimators/two_views.h"
#include "hullslam/features/feature_grid.h"
#include "hullslam/map/map.h"
#include "matching/match.h"
#include "tracking/local_map_tracking.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The matches of keypoints of a (Match::query) with keypoints of b, for EstimateTwoViews. The sigma
// of a keypoint is the scale of its level.
std::vector<PixelPair> MakePixelPairs(const FrameFeatures& a, const FrameFeatures& b,
                                      std::span<const Match> matches, const ScaleLevels& levels);

// What pairs of images say of the pose of a frame, without the landmarks of the map: the number of
// keyframes from which the motion to the frame has the rotation that their poses say, and of those
// from which it has another one. A pair that gives no motion does not vote.
struct PairVotes {
  int agree = 0;
  int contradict = 0;
};

// The votes of the keyframes of the place at which the frame was tracked. The motion of a pair is
// that of EstimateTwoViews, from matches without a prediction. Some milliseconds per keyframe.
PairVotes VoteByPairs(const Frame& frame, const Map& map, const TrackingContext& context,
                      const LocalTracking& tracking);

}  // namespace hullslam
