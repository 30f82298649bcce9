// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimators/two_views.h"
#include "hullslam/features/feature_set.h"
#include "hullslam/features/frame_features.h"
#include "matching/match.h"

namespace hullslam {

// The matches of keypoints of a (Match::query) with keypoints of b, for EstimateTwoViews. The sigma
// of a keypoint is the scale of its level.
std::vector<PixelPair> MakePixelPairs(const FrameFeatures& a, const FrameFeatures& b,
                                      std::span<const Match> matches, const ScaleLevels& levels);

}  // namespace hullslam
