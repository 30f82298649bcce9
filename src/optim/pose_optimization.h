// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "camera/depth_error.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// A landmark found in the image.
struct PoseObservation {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // m, world frame
  PointMeasurement measurement;
};

struct PoseOptimizationOptions {
  int rounds = 4;                       // inliers are chosen anew after each
  int robust_rounds = 3;                // the first ones use Huber's loss
  int iterations = 10;                  // at most, a round
  double min_relative_decrease = 1e-5;  // of the cost; a round ends below it
};

struct PoseOptimizationResult {
  Rigid3 cam_from_world;
  std::vector<uint8_t> is_inlier;  // one an observation
  int inlier_count = 0;
};

// The pose that best explains the observations: Levenberg-Marquardt on the six numbers of Retract,
// points held fixed (Mur-Artal and Tardos 2017, section III.C). With fewer than three inliers the
// start is given back.
PoseOptimizationResult OptimizePose(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                    std::span<const PoseObservation> observations,
                                    const PoseOptimizationOptions& options = {});

}  // namespace hullslam
