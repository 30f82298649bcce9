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
  double max_ratio = 0.7;  // of the best to the second best
};

// Compares every keypoint of `queries` in `indices` with every one of `features`, without any guess
// of where to look; rotations must agree. Match::query is a keypoint index.
std::vector<Match> MatchByDescriptor(const FrameFeatures& queries,
                                     std::span<const uint32_t> indices,
                                     const FrameFeatures& features, const DescriptorSearch& search);

}  // namespace hullslam
