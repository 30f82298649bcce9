// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "geometry/matrix_pose.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"
#include "optim/block_cholesky.h"
#include "optim/bundle_points.h"
#include "optim/robust.h"

namespace hullslam::internal {

// Eliminates the points from a bundle adjustment. The cost is
//   F(p, x) = sum over inlier observations (j, i) of weight / 2 rho(|PointResidual(p_j x_i)|^2)
// for poses p_j and points x_i, where rho is the loss (PointLoss). For given poses, the best
// position x_i*(p) of each point does not depend on the other points. So f(p) = F(p, x*(p)) is a
// function of the poses alone. This class evaluates f and its Gauss-Newton approximation.
//
// A Gauss-Newton step of poses and points solves the normal equations, in which a point is only
// coupled with the poses that see it:
//   H_pp dp + sum_i H_pi dx_i = -g_p   and   H_ip dp + H_ii dx_i = -g_i  for each point i.
// The second equation gives dx_i = -H_ii^-1 (g_i + H_ip dp). Inserted into the first one, it leaves
// the reduced normal equations S dp = -s of the poses, the Schur complement of the points:
//   S = H_pp - sum_i H_pi H_ii^-1 H_ip,   s = g_p - sum_i H_pi H_ii^-1 g_i
// (Triggs et al. 2000, "Bundle Adjustment: A Modern Synthesis", section 6.1). At x*(p) all g_i are
// zero, and s is the gradient of f. Follow() returns f, Linearize() returns S and s.
//
// Poses are cam_from_world. Derivatives are by the six parameters of Retract.
class EliminatedPoints {
 public:
  // The first `moving` poses move, the others are fixed. `points` must outlive this object.
  EliminatedPoints(const PinholeCamera& camera, BundlePoints& points, size_t moving, PointLoss loss,
                   const FollowOptions& follow = {});

  size_t moving() const { return moving_; }

  // Moves every point towards its best position for these poses and returns the cost f. Each point
  // starts at its accepted position, which does not change before Accept(). A point that is nearer
  // than kMinDepth to a camera that sees it as an inlier, or behind it, costs chi2_behind.
  double Follow(std::span<const Rigid3> poses);
  // Accepts the positions that the last Follow() found.
  void Accept();

  // Computes S as `hessian` (6 moving x 6 moving, lower half) and s as `gradient`, at the accepted
  // positions and the poses of the last Follow(). The three parameters of the rotation of a pose
  // come before those of its translation.
  void Linearize(Eigen::MatrixXd& hessian, Eigen::VectorXd& gradient);
  // The same for an S that is mostly zero.
  void Linearize(BlockCholesky& hessian, Eigen::VectorXd& gradient);
  // Of each moving pose those after it that see one of its points: where S has blocks.
  std::vector<std::set<uint32_t>> CoupledPoses() const;

 private:
  // The cost of one point and its derivatives by the point.
  struct PointSystem {
    // Adds weight / 2 times the squared norm of an observation's residual, whose derivative by the
    // point is `jacobian`. Only the lower half of the Hessian is computed.
    void Add(double weight, const Eigen::Vector3d& residual, const Eigen::Matrix3d& jacobian) {
      const Eigen::Matrix3d weighted = weight * jacobian;
      for (int column = 0; column < 3; ++column) {
        for (int row = column; row < 3; ++row) {
          hessian(row, column) += weighted.col(row).dot(jacobian.col(column));
        }
      }
      gradient.noalias() += weighted.transpose() * residual;
    }

    double cost = 0.0;
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  // lower half
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  };
  // Second derivative of the cost of an observation, by the pose and the point.
  struct Coupling {
    size_t pose = 0;
    Eigen::Matrix<double, 6, 3> block;
  };

  // Half of rho, and its derivative by half of the squared residual.
  double Loss(double chi2, const BundlePoints::PointObservation& observation) const;
  double CostOf(size_t point, const Eigen::Vector3d& position) const;
  double WeightOf(double chi2, const BundlePoints::PointObservation& observation) const;
  PointSystem SystemOf(size_t point, const Eigen::Vector3d& position) const;
  double MovePoint(size_t point, Eigen::Vector3d& position, double& damping) const;
  // `block_at(row, column)` returns a block of S.
  template <typename BlockAt>
  void Sum(const BlockAt& block_at, Eigen::VectorXd& gradient);
  template <typename BlockAt>
  void AddView(const BundlePoints::PointObservation& observation, const Eigen::Vector3d& position,
               const BlockAt& block_at, PointSystem& point, Eigen::VectorXd& gradient);
  template <typename BlockAt>
  void Eliminate(const PointSystem& point, double damping, const BlockAt& block_at,
                 Eigen::VectorXd& gradient) const;

  PinholeCamera camera_;
  BundlePoints& points_;
  size_t moving_;
  PointLoss loss_;
  FollowOptions follow_;
  std::vector<MatrixPose> poses_;
  std::vector<Eigen::Vector3d> moved_;  // the positions that the last Follow() found
  // The damping of each point's own Levenberg-Marquardt steps. The Schur complement uses it too,
  // because a point whose steps failed does not move as far as the undamped equations predict.
  std::vector<double> damping_;
  std::vector<Coupling> couplings_;  // couplings of one point; kept to save allocations
};

}  // namespace hullslam::internal
