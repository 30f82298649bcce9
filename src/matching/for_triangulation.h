// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/features/feature_grid.h"
#include "matching/match.h"

namespace hullslam {

struct TriangulationSearch {
  int max_distance = 50;  // Hamming
  // px^2 over sigma^2; 95 % of a chi-square distribution with one degree of freedom
  double max_epipolar_chi2 = 3.84;
  double min_epipole_distance = 10.0;  // px at level 0; the parallax is too small below this
};

// Pairs keypoints of image a (`a_indices`) with keypoints of image b (`b_indices`) that have
// similar descriptors and lie on the epipolar line. `fundamental` maps a pixel of a to its line in
// b: x_b^T F x_a = 0. `epipole` is the pixel where the line through both camera centres meets image
// b. If camera a is in front of b, it is the image of a. Points near the epipole have little
// parallax, also if a is behind b. So no pairs are made near the epipole if both depths are
// unknown. Distances are measured in the raw image b of the camera, to first order.
std::vector<Match> MatchForTriangulation(
    const FrameFeatures& a, std::span<const uint32_t> a_indices, const FrameFeatures& b,
    std::span<const uint32_t> b_indices, const Eigen::Matrix3d& fundamental,
    const Eigen::Vector2d& epipole, const ScaleLevels& levels, const PinholeCamera& camera,
    const TriangulationSearch& search = {});

}  // namespace hullslam
