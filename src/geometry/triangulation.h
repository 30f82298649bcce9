// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// Essential matrix E with x_b^T E x_a = 0 for normalised image points (Longuet-Higgins 1981).
Eigen::Matrix3d EssentialFromPose(const Rigid3& b_from_a);

// Fundamental matrix K_b^-T E K_a^-1 for pixels of cameras with calibration matrices `k_a` and
// `k_b`.
Eigen::Matrix3d FundamentalFromPose(const Rigid3& b_from_a, const Eigen::Matrix3d& k_a,
                                    const Eigen::Matrix3d& k_b);

// Linear triangulation of one point from two views (Hartley and Zisserman 2004, section 12.2). The
// image points are normalised (x/z, y/z). Returns the point in the world frame, or nothing if it is
// at infinity. The point may lie behind a camera: the caller must check this.
std::optional<Eigen::Vector3d> TriangulatePoint(const Rigid3& a_from_world,
                                                const Eigen::Vector2d& point_in_a,
                                                const Rigid3& b_from_world,
                                                const Eigen::Vector2d& point_in_b);

}  // namespace hullslam
