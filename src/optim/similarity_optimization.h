// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimators/similarity_error.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/sim3.h"
#include "optim/pose_optimization.h"

namespace hullslam {

struct SimilarityOptimizationOptions {
  bool fix_scale = false;               // the result has the scale of the start, to the last bit
  PoseOptimizationOptions rounds = {};  // as in OptimizePose
};

struct SimilarityOptimizationResult {
  Sim3 b_from_a;
  std::vector<uint8_t> is_inlier;  // one per match
  int inlier_count = 0;
};

// The similarity between the camera frames of two keyframes that explains their matches best, from
// a start as EstimateSimilarity gives it. Minimises the reprojection errors in both images while
// the landmarks are fixed in the frames of their keyframes (Mur-Artal and Tardos 2014, section
// IV.C), each with Huber's loss in the first rounds; with a free scale, also
// SimilarityDepthResidual. After each round the matches with a SimilarityError of at most 1 are the
// inliers. With fewer than three inliers the result is the start. All numbers must be finite.
SimilarityOptimizationResult OptimizeSimilarity(const PinholeCamera& camera, const Sim3& b_from_a,
                                                std::span<const SimilarityMatch> matches,
                                                const SimilarityOptimizationOptions& options = {});

}  // namespace hullslam
