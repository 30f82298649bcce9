// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hullslam/features/frame_features.h"
#include "matching/match.h"

namespace hullslam {

// The expected view of a point in an image, and the search window around it.
struct Projection {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  // px, as in the grid (Sensor::ToGrid)
  float right_u = -1.0f;  // px in the virtual right image; below 0: not compared
  float radius = 0.0f;    // px; half side of the search window and bound on the error of right_u
  int min_level = 0;
  int max_level = 0;
  Descriptor descriptor{};
  float angle = 0.0f;  // radians; used if rotations are compared
};

struct ProjectionSearch {
  int max_distance = 100;  // Hamming
  // The best distance must be below this share of the second best at the same level. 1: no such
  // test.
  double max_ratio = 1.0;
  bool compare_rotation = false;
  // Decides whether a projection (index) may be matched to a keypoint (index) of its window. It is
  // asked before descriptors are compared. Empty: all may be matched.
  std::function<bool(uint32_t, uint32_t)> may_match = {};
};

// Finds for each projection the keypoint in its window with the most similar descriptor. A keypoint
// is matched to at most one projection. `taken` is empty or has one entry per keypoint; keypoints
// with a nonzero entry are not matched.
std::vector<Match> MatchByProjection(const FrameFeatures& features,
                                     std::span<const Projection> projections,
                                     std::span<const uint8_t> taken,
                                     const ProjectionSearch& search);

}  // namespace hullslam
