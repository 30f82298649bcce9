// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/epipolar.h"

#include <Eigen/LU>

namespace hullslam {

Eigen::Matrix3d EssentialFromPose(const Rigid3& b_from_a) {
  return Skew(b_from_a.translation) * b_from_a.rotation.toRotationMatrix();
}

Eigen::Matrix3d FundamentalFromPose(const Rigid3& b_from_a, const Eigen::Matrix3d& k_a,
                                    const Eigen::Matrix3d& k_b) {
  return k_b.inverse().transpose() * EssentialFromPose(b_from_a) * k_a.inverse();
}

}  // namespace hullslam
