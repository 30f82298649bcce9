// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// Essential matrix E with x_b^T E x_a = 0 for normalised image points (Longuet-Higgins 1981).
Eigen::Matrix3d EssentialFromPose(const Rigid3& b_from_a);

// Fundamental matrix K_b^-T E K_a^-1 for pixels of cameras with calibration matrices `k_a` and
// `k_b`.
Eigen::Matrix3d FundamentalFromPose(const Rigid3& b_from_a, const Eigen::Matrix3d& k_a,
                                    const Eigen::Matrix3d& k_b);

}  // namespace hullslam
