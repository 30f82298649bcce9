// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "estimators/ransac.h"
#include "estimators/similarity_error.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/sim3.h"

namespace hullslam {

struct SimilarityOptions {
  // In RGB-D the scale is known to be 1. For a monocular sensor the quotients of the landmarks'
  // depths are part of the fit, with a low weight (SimilarityDepthResidual).
  bool fix_scale = false;
  RansacOptions ransac;
};

struct Similarity {
  Sim3 b_from_a;                // between the camera frames of the keyframes
  std::vector<size_t> inliers;  // indices of matches, increasing
  double score = 0.0;           // sum over the inliers of 1 - SimilarityError
  int iterations = 0;           // samples drawn
  std::string failure;          // empty if the similarity was found, else the reason

  bool ok() const { return failure.empty(); }
};

// The similarity between the camera frames of two keyframes that see the same place, from matches,
// many of which may be wrong. RANSAC aligns three matches at a time (AlignPoints). A match is an
// inlier if its SimilarityError is below 1: each of the two landmarks must project to the keypoint
// of the other keyframe. The similarity is fitted to all inliers, without a robust loss;
// OptimizeSimilarity can refine it. Matches whose numbers are not finite, or with a landmark behind
// its own keyframe's camera, are never inliers.
//
// Possible failures: there are too few matches; no three of them span a triangle; too few agree; or
// the inliers do not determine rotation and scale.
Similarity EstimateSimilarity(const PinholeCamera& camera, std::span<const SimilarityMatch> matches,
                              const SimilarityOptions& options);

}  // namespace hullslam
