// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "costs/pose_manifold.h"
#include "optim/eliminated_points.h"

namespace hullslam::internal {

// What EliminatedPoints leaves of the points, as one cost on all moving poses, which Ceres can
// solve together with other costs on these poses.
//
// Ceres wants residuals r and their Jacobian J. With the Cholesky factor S = L L^T of the reduced
// Hessian and the reduced gradient g,
//   r = L^-1 g and J = L^T give J^T J = S and J^T r = g.
// One more residual, sqrt(2 cost - |r|^2), has no derivative and makes 1/2 |r|^2 the true cost.
//
// The problem must have this object as its evaluation callback too: that is how it learns when
// Ceres tries other poses and when it keeps them.
class ReducedPointsCost final : public ceres::CostFunction, public ceres::EvaluationCallback {
 public:
  // `poses` are all poses that see the points, the moving ones first; the parameter blocks are the
  // moving ones, with PoseManifold. Both arguments must outlive this object.
  ReducedPointsCost(EliminatedPoints& points, const std::vector<PoseBlock>& poses);

  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;
  // False if a point is not in front of a camera that sees it as an inlier.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  void Linearize();

  EliminatedPoints& points_;
  const std::vector<PoseBlock>& poses_;
  std::vector<Rigid3> cam_from_world_;
  double cost_ = 0.0;
  bool has_moved_ = false;  // since the points were accepted
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd residual_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace hullslam::internal
