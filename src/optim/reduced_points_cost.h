// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>

#include <Eigen/Core>
#include <cstdint>
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
// own, and Ceres does not multiply the zeros. In a large map most poses share no points. Then the
// poses are eliminated in an order in which L has few blocks (Amestoy et al. 1996), and only these
// are stored (BlockCholesky).
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
  // object must outlive it. The evaluation fails at poses for which a point is not in front of a
  // camera that sees it as an inlier.
  void AddResiduals(ceres::Problem& problem);

  // Moves the points towards their best positions at the present poses, this often.
  void FollowPoints(int times);

  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

 private:
  // Six rows of L^T. The last ones include the residual that completes the cost.
  class RowsOfPose final : public ceres::CostFunction {
   public:
    RowsOfPose(const ReducedPointsCost& all, size_t row);
    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override;

   private:
    const ReducedPointsCost& all_;
    const size_t row_;  // counts blocks, as all rows and columns here
  };

  // The columns of the blocks of L^T in a row that may not be zero.
  std::vector<uint32_t> ColumnsOf(size_t row) const;
  Eigen::Matrix<double, 6, 6> JacobianBlock(size_t row, size_t column) const;
  const Eigen::VectorXd& residual() const {
    return sparse_ ? sparse_->residual() : form_.residual();
  }

  EliminatedPoints& points_;
  std::vector<PoseBlock>& poses_;
  std::vector<uint32_t> order_;  // the pose of each row
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
