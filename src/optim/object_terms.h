// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "costs/manifolds.h"
#include "costs/wrapped_costs.h"
#include "optim/joint_pose_optimization.h"
#include "optim/pose_problem.h"

namespace hullslam::internal {

// The robust silhouette residuals of objects as a function of the camera's pose. Only the
// constructor allocates memory.
class ObjectTerms {
 public:
  // Objects that have no residual at `start` are not used.
  ObjectTerms(const PinholeCamera& camera, const Rigid3& start, std::span<const PoseObject> objects,
              const ObjectPoseOptions& options);

  // The cost of the used objects; infinite if one of them is not in front of the camera.
  double Cost(const Rigid3& pose) const;
  // Adds the terms of the used objects to hessian and gradient.
  void Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const;

  // Decides again which objects are used, from their residuals at this pose.
  void Choose(const Rigid3& pose);
  int used() const;
  void Write(JointPoseResult& result) const;

 private:
  struct Term {
    std::unique_ptr<RobustRowsCost> cost;  // null if the object has no residual
    PoseBlock world_from_object{};
    Eigen::Vector3d log_axes = Eigen::Vector3d::Zero();
    bool is_used = false;
  };
  // Writes the plain residuals and, if asked for, their derivative by the pose into the buffers
  // below. Returns false if they are undefined at this pose.
  bool Evaluate(const Term& term, const PoseBlock& pose, bool with_derivative) const;

  std::vector<Term> terms_;
  double outlier_;  // in sigmas; a residual beyond it is an outlier
  // Buffers of the size of the largest term.
  mutable Eigen::VectorXd residuals_;
  mutable Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor> by_pose_;
};

}  // namespace hullslam::internal
