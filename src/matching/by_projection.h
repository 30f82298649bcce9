// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "hullslam/features/feature_grid.h"
#include "matching/match.h"

namespace hullslam {

// The expected view of a point in an image, and the search window around it.
struct Projection {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  // px, raw
  float radius = 0.0f;                              // px; half side of the search window
  // Keypoints with a depth out of this range are not matched, m.
  float nearest = 0.0f;
  float farthest = std::numeric_limits<float>::infinity();
  int min_level = 0;
  int max_level = 0;
  Descriptor descriptor{};
  float angle = 0.0f;  // radians; used if rotations are compared

  // Sets the range of depths whose disparities bf / z deviate by at most `radius` from that of the
  // depth `z` (m).
  void ExpectDepth(double z, double bf);
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
