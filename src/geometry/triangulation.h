// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// Linear triangulation of one point from two views (Hartley and Zisserman 2004, section 12.2). The
// image points are normalised (x/z, y/z). The point is in the world frame; nothing where it is at
// infinity. It may lie behind a camera: the caller checks.
std::optional<Eigen::Vector3d> TriangulatePoint(const Rigid3& a_from_world,
                                                const Eigen::Vector2d& point_in_a,
                                                const Rigid3& b_from_world,
                                                const Eigen::Vector2d& point_in_b);

}  // namespace hullslam
