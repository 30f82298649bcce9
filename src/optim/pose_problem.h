// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "optim/pose_optimization.h"

namespace hullslam::internal {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// The robust squared errors of the inliers among the observations.
class PointTerms {
 public:
  PointTerms(const PinholeCamera& camera, std::span<const PoseObservation> observations,
             const std::vector<uint8_t>& is_inlier, bool robust)
      : camera_(camera), observations_(observations), is_inlier_(is_inlier), robust_(robust) {}

  // Infinite if an inlier is behind the camera.
  double Cost(const Rigid3& pose) const;
  // Sets hessian and gradient with respect to the six parameters of Retract, both without the
  // factor 2.
  void Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const;

 private:
  const PinholeCamera& camera_;
  std::span<const PoseObservation> observations_;
  const std::vector<uint8_t>& is_inlier_;
  bool robust_;
};

// Decides which observations are inliers at the result's pose: those whose error is below their
// OutlierBound, or all that are in front of the camera.
enum class InlierRule { kBelowBound, kInFront };
void ChooseInliers(const PinholeCamera& camera, std::span<const PoseObservation> observations,
                   InlierRule rule, PoseOptimizationResult& result);

// Levenberg-Marquardt on the six parameters of Retract. A Problem has functions Cost and Linearize
// like those of PointTerms.
template <typename Problem>
Rigid3 Minimize(const Problem& problem, Rigid3 pose, const PoseOptimizationOptions& options) {
  Matrix6d hessian;
  Vector6d gradient;
  double damping = 1e-5;  // relative to the diagonal
  double cost = problem.Cost(pose);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    problem.Linearize(pose, hessian, gradient);
    Matrix6d damped = hessian;
    damped.diagonal() += damping * hessian.diagonal() + Vector6d::Constant(1e-12);
    const Vector6d step = damped.ldlt().solve(-gradient);
    if (!step.allFinite()) {
      break;
    }
    const Rigid3 moved = Retract(pose, step);
    const double moved_cost = problem.Cost(moved);
    if (!(moved_cost < cost)) {
      damping *= 10.0;
      continue;
    }
    const double decrease = (cost - moved_cost) / cost;
    pose = moved;
    cost = moved_cost;
    damping = std::max(damping * 0.1, 1e-9);
    if (decrease < options.min_relative_decrease) {
      break;
    }
  }
  return pose;
}

}  // namespace hullslam::internal
