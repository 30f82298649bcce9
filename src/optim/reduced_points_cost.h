// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "costs/manifolds.h"
#include "optim/block_cholesky.h"
#include "optim/eliminated_points.h"
#include "optim/square_root_form.h"

namespace ceres {
class Problem;
}

namespace hullslam::internal {

// The reduced normal equations of EliminatedPoints as costs on the moving poses, which Ceres can
// minimise together with other costs on these poses.
//
// EliminatedPoints gives the cost f(p), the Hessian S and the gradient s. With S = L L^T, the
// residuals are r = L^-1 s, six per moving pose, with the Jacobian L^T (SquareRootForm), and one
// more residual, sqrt(2 f - |r|^2), whose derivative is zero. Half of the squared norm of all
// residuals is f. The Jacobian L^T is upper triangular, so the six residuals of a pose depend only
// on this pose and the poses after it. So the residuals of each pose are a residual block of their
// own, and Ceres does not multiply the zeros. In a large map most poses share no points, so
// only the blocks of L are stored (BlockCholesky).
//
// This object must be the evaluation callback of the problem, because it has to know when Ceres
// tries other poses and when it accepts them.
class ReducedPointsCost final : public ceres::EvaluationCallback {
 public:
  // `poses` are all poses that see the points, with the moving ones first. The parameter blocks are
  // the moving ones, with PoseManifold. Both arguments must outlive this object.
  ReducedPointsCost(EliminatedPoints& points, std::vector<PoseBlock>& poses,
                    bool is_sparse = false);
  ReducedPointsCost(const ReducedPointsCost&) = delete;
  ReducedPointsCost& operator=(const ReducedPointsCost&) = delete;

  // Adds one residual block per moving pose. The problem must not own its cost functions, and this
  // object must outlive it. The evaluation fails where the cost is infinite (EliminatedPoints).
  void AddResiduals(ceres::Problem& problem);

  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

 private:
  // The residuals of one pose. Those of the last pose include the one that completes the cost.
  class RowsOfPose final : public ceres::CostFunction {
   public:
    RowsOfPose(const ReducedPointsCost& all, size_t pose);
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override;

   private:
    const ReducedPointsCost& all_;
    const size_t pose_;
  };

  // The poses on which the residuals of a pose depend.
  std::vector<size_t> PosesOf(size_t pose) const;
  const Eigen::VectorXd& residual() const {
    return sparse_ ? sparse_->residual() : form_.residual();
  }

  EliminatedPoints& points_;
  std::vector<PoseBlock>& poses_;
  std::optional<BlockCholesky> sparse_;
  std::deque<RowsOfPose> rows_;
  std::vector<Rigid3> cam_from_world_;
  double cost_ = 0.0;
  bool has_moved_ = false;  // since the points were accepted
  Eigen::VectorXd gradient_;
  SquareRootForm<Eigen::Dynamic> form_;  // if it is not sparse
  bool has_form_ = false;
};

}  // namespace hullslam::internal
