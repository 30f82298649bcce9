// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"
#include "optim/bundle_points.h"
#include "optim/matrix_pose.h"
#include "optim/robust.h"

namespace hullslam::internal {

// Removes the points from a bundle adjustment. For given poses each point has a best place of its
// own, which does not depend on the other points. With all points at their best places the cost
//   sum over inlier views of weight / 2 rho(|PointResidual|^2)
// is a function of the poses alone. This class evaluates it and gives its Gauss-Newton
// approximation: the Schur complement of the points (Triggs et al. 2000, "Bundle Adjustment: A
// Modern Synthesis", section 6.1). rho is the loss (PointLoss).
//
// Poses are cam_from_world. Derivatives are by the six parameters of Retract.
class EliminatedPoints {
 public:
  // The poses with the first `moving` indices move, the others are fixed. `points` must outlive
  // this object.
  EliminatedPoints(const PinholeCamera& camera, BundlePoints& points, size_t moving, PointLoss loss,
                   const FollowOptions& follow = {});

  size_t moving() const { return moving_; }

  // Moves every point towards its best place for these poses and returns the cost there. The points
  // start at the positions that were accepted last, which stay as they are until Accept(). Infinite
  // if an inlier view is not at least kMinDepth in front of its camera.
  double Follow(std::span<const Rigid3> poses);
  // Keeps the places that the last Follow() found.
  void Accept();

  // The Gauss-Newton approximation at the accepted positions and the poses of the last Follow():
  // the Hessian (6 moving x 6 moving, lower half) and the gradient. The three parameters of the
  // rotation of a pose come before those of its translation.
  void Linearize(Eigen::MatrixXd& hessian, Eigen::VectorXd& gradient);

 private:
  // The cost of one point and its derivatives by the point.
  struct PointSystem {
    // Adds weight / 2 times the squared norm of a view's residual, whose derivative by the point is
    // `jacobian`. Of the Hessian only the lower half.
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
  // Second derivative of the cost of a view, by the pose and the point.
  struct Coupling {
    Eigen::Index pose = 0;  // row of its first parameter
    Eigen::Matrix<double, 6, 3> block;
  };

  // Half of rho, and its derivative by half of the squared residual.
  double Loss(double chi2, const BundlePoints::View& view) const;
  double CostOf(size_t point, const Eigen::Vector3d& position) const;
  double WeightOf(double chi2, const BundlePoints::View& view) const;
  PointSystem SystemOf(size_t point, const Eigen::Vector3d& position) const;
  double MovePoint(size_t point, Eigen::Vector3d& position, double& damping) const;
  void AddView(const BundlePoints::View& view, const Eigen::Vector3d& position, PointSystem& point,
               Eigen::MatrixXd& hessian, Eigen::VectorXd& gradient);
  void Eliminate(const PointSystem& point, double damping, Eigen::MatrixXd& hessian,
                 Eigen::VectorXd& gradient) const;

  PinholeCamera camera_;
  BundlePoints& points_;
  size_t moving_;
  PointLoss loss_;
  FollowOptions follow_;
  std::vector<MatrixPose> poses_;
  std::vector<Eigen::Vector3d> moved_;  // the places of the last Follow()
  // A point whose steps failed keeps its damping, and the Schur complement uses it too: such a
  // point does not move as far as the undamped equations say.
  std::vector<double> damping_;
  std::vector<Coupling> couplings_;  // of one point; kept to save allocations
};

}  // namespace hullslam::internal
