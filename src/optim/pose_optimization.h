// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "camera/point_measurement.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

struct PoseOptimizationOptions {
  int rounds = 4;         // the inliers are chosen again after each round
  int robust_rounds = 3;  // the first rounds, which use Huber's loss
  int iterations = 10;    // largest number per round
  // A round ends after a step that decreases the cost by less than this share.
  double min_relative_decrease = 1e-5;
};

struct PoseOptimizationResult {
  Rigid3 cam_from_world;
  std::vector<uint8_t> is_inlier;  // one per observation
  int inlier_count = 0;
};

// The pose that explains the observations best: Levenberg-Marquardt (ceres::TinySolver) on the six
// parameters of Retract, while the points are fixed (Mur-Artal and Tardos 2017, section III.C).
// With fewer than three inliers the result is the start.
PoseOptimizationResult OptimizePose(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                    std::span<const PoseObservation> observations,
                                    const PoseOptimizationOptions& options = {});

}  // namespace hullslam
