// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "costs/pose_manifold.h"
#include "optim/eliminated_points.h"
#include "optim/square_root_form.h"

namespace ceres {
class Problem;
}

namespace hullslam::internal {

// What EliminatedPoints leaves of the points, as costs on the moving poses, which Ceres can solve
// together with other costs on these poses.
//
// The residuals are the SquareRootForm of the normal equations, six for each moving pose, and one
// more that makes half of their squared norm the true cost. The Jacobian is an upper triangular
// matrix: the six residuals of a pose depend on this pose and on those after it. So each six are a
// cost of their own, and Ceres never multiplies the zeros.
//
// The problem must have this object as its evaluation callback: that is how it learns when Ceres
// tries other poses and when it keeps them.
class ReducedPointsCost final : public ceres::EvaluationCallback {
 public:
  // `poses` are all poses that see the points, the moving ones first. The parameter blocks are the
  // moving ones, with PoseManifold. Both arguments must outlive this object.
  ReducedPointsCost(EliminatedPoints& points, std::vector<PoseBlock>& poses);
  ReducedPointsCost(const ReducedPointsCost&) = delete;
  ReducedPointsCost& operator=(const ReducedPointsCost&) = delete;

  // Adds one residual block per moving pose. The problem must not own its cost functions, and this
  // object must outlive it. The blocks cannot be evaluated where a point is not in front of a
  // camera that sees it as an inlier.
  void AddResiduals(ceres::Problem& problem);

  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

 private:
  // The residuals of one pose. The last pose has the one that completes the cost too.
  class RowsOfPose final : public ceres::CostFunction {
   public:
    RowsOfPose(const ReducedPointsCost& all, size_t pose);
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override;

   private:
    const ReducedPointsCost& all_;
    const Eigen::Index first_;  // row of its first residual
  };

  EliminatedPoints& points_;
  std::vector<PoseBlock>& poses_;
  std::deque<RowsOfPose> rows_;
  std::vector<Rigid3> cam_from_world_;
  double cost_ = 0.0;
  bool has_moved_ = false;  // since the points were accepted
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd gradient_;
  SquareRootForm<Eigen::Dynamic> form_;
  bool has_form_ = false;
};

}  // namespace hullslam::internal
