// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/features/feature_grid.h"

namespace hullslam {

// Appends what one search finds to `found`.
inline void FindNear(const FeatureGrid& grid, std::span<const Keypoint> keypoints,
                     const Eigen::Vector2f& center, float radius, int min_level, int max_level,
                     std::vector<uint32_t>& found) {
  GridSearch search(grid, keypoints);
  const std::span<const uint32_t> near = search.FindNear(center, radius, min_level, max_level);
  found.insert(found.end(), near.begin(), near.end());
}

}  // namespace hullslam
