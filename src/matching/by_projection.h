// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/features/frame_features.h"
#include "matching/match.h"

namespace hullslam {

// Where something seen before is expected in an image.
struct Projection {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  // px, undistorted
  float right_u = -1.0f;  // px in the virtual right image; below 0 where it is not to be compared
  float radius = 0.0f;    // px; half side of the window searched, and bound on the error of right_u
  int min_level = 0;
  int max_level = 0;
  Descriptor descriptor{};
  float angle = 0.0f;  // radians; used where rotations are compared
};

struct ProjectionSearch {
  int max_distance = 100;  // Hamming
  // The best must be below this share of the second best at the same level; 1: no such test.
  double max_ratio = 1.0;
  bool compare_rotation = false;
};

// For every projection the keypoint in its window with the nearest descriptor; one keypoint serves
// one projection. Keypoints with a nonzero entry in `taken` (empty, or one a keypoint) are left
// out.
std::vector<Match> MatchByProjection(const FrameFeatures& features,
                                     std::span<const Projection> projections,
                                     std::span<const uint8_t> taken,
                                     const ProjectionSearch& search);

}  // namespace hullslam
