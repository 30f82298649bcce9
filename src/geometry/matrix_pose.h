// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// A pose whose rotation is a matrix. A matrix transforms many points faster than a quaternion does.
struct MatrixPose {
  MatrixPose(const Rigid3& pose)
      : rotation(pose.rotation.toRotationMatrix()), translation(pose.translation) {}

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }

  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
};

}  // namespace hullslam
