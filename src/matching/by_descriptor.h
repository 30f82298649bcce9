// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/features/frame_features.h"
#include "matching/match.h"

namespace hullslam {

struct DescriptorSearch {
  int max_distance = 50;   // Hamming
  double max_ratio = 0.7;  // largest ratio of the best distance to the second best
};

// Compares every keypoint of `queries` that is listed in `indices` with every keypoint of
// `features`, without a prediction of its position. The rotations of the matches must agree.
// Match::query is a keypoint index.
std::vector<Match> MatchByDescriptor(const FrameFeatures& queries,
                                     std::span<const uint32_t> indices,
                                     const FrameFeatures& features, const DescriptorSearch& search);

}  // namespace hullslam
