// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>

#include <Eigen/Core>
#include <vector>

#include "costs/pose_manifold.h"
#include "optim/eliminated_points.h"
#include "optim/square_root_form.h"

namespace hullslam::internal {

// What EliminatedPoints leaves of the points, as one cost on all moving poses, which Ceres can
// solve together with other costs on these poses.
//
// Its residuals are the SquareRootForm of the normal equations, six for each moving pose, and one
// more that makes half of their squared norm the true cost.
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
  EliminatedPoints& points_;
  const std::vector<PoseBlock>& poses_;
  std::vector<Rigid3> cam_from_world_;
  double cost_ = 0.0;
  bool has_moved_ = false;  // since the points were accepted
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd gradient_;
  SquareRootForm<Eigen::Dynamic> form_;
  bool has_form_ = false;
};

}  // namespace hullslam::internal
