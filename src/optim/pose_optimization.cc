// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/pose_optimization.h"

#include "optim/pose_problem.h"

namespace hullslam {

PoseOptimizationResult OptimizePose(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                    std::span<const PoseObservation> observations,
                                    const PoseOptimizationOptions& options) {
  PoseOptimizationResult result;
  result.cam_from_world = cam_from_world;
  result.is_inlier.assign(observations.size(), 0);
  // In the first round all points in front of the camera are inliers. The error of a point behind
  // the camera is infinite, so it would make the sum infinite.
  internal::ChooseInliers(camera, observations, internal::InlierRule::kInFront, result);
  for (int round = 0; round < options.rounds && result.inlier_count >= 3; ++round) {
    const internal::PointTerms problem(camera, observations, result.is_inlier,
                                       round < options.robust_rounds);
    result.cam_from_world = internal::Minimize(problem, result.cam_from_world, options);
    if (!internal::ChooseInliers(camera, observations, internal::InlierRule::kBelowBound, result)) {
      break;  // below the bound Huber's loss is the squared error: more rounds change nothing
    }
  }
  if (result.inlier_count < 3) {
    result.cam_from_world = cam_from_world;
  }
  return result;
}

}  // namespace hullslam
