// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "costs/pose_manifold.h"
#include "costs/robust_rows.h"
#include "optim/joint_pose_optimization.h"
#include "optim/pose_problem.h"

namespace hullslam::internal {

// The robust errors of objects' outlines as a function of the camera's pose. Memory is allocated
// once, in the constructor.
class ObjectTerms {
 public:
  // Objects that have no residual at `start` are not used.
  ObjectTerms(const PinholeCamera& camera, const Rigid3& start, std::span<const PoseObject> objects,
              const ObjectPoseOptions& options);

  // Of the objects in use; infinite where one is not in front of the camera.
  double Cost(const Rigid3& pose) const;
  // Adds to hessian and gradient.
  void Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const;

  // Decides anew which objects are used.
  void Choose(const Rigid3& pose);
  int used() const;
  void Write(JointPoseResult& result) const;

 private:
  struct Term {
    std::unique_ptr<RobustRowsCost> cost;  // null: the object has no residual
    PoseBlock world_from_object{};
    Eigen::Vector3d log_axes = Eigen::Vector3d::Zero();
    bool is_used = false;
  };
  // The plain residuals, and their derivative by the pose if asked for, into the buffers below.
  bool Evaluate(const Term& term, const PoseBlock& pose, bool with_derivative) const;

  std::vector<Term> terms_;
  double outlier_;  // sigmas: a residual beyond it is an outlier
  // Scratch, of the size of the largest term.
  mutable Eigen::VectorXd residuals_;
  mutable Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor> by_pose_;
};

}  // namespace hullslam::internal
