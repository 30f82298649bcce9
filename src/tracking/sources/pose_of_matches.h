// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "places/landmark_search.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The pose on which most of the matches between keypoints of the frame and landmarks agree, found
// by RANSAC without an initial pose and then refined. The estimate has the landmarks that agree.
// Null if fewer than `min_inliers` agree. `purpose` makes the samples different from those of other
// searches for the same frame.
std::optional<PoseEstimate> PoseOfMatches(const Frame& frame, const Map& map,
                                          const TrackingContext& context,
                                          std::span<const FoundLandmark> matches,
                                          size_t min_inliers, std::string_view purpose);

}  // namespace hullslam
