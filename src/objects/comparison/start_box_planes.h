// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "objects/start_method.h"

namespace hullslam {

// The ellipsoid of a dual quadric of any scale: with its last element scaled to -1 it is
// [[M - t t^T, -t], [-t^T, -1]] with the centre t and M = R diag(s^2) R^T. If M is not positive,
// the quadric is no ellipsoid; then the absolute values of its eigenvalues are taken, as
// QuadricSLAM does. Nothing if the centre is infinitely far away or a half axis is zero.
std::optional<Ellipsoid> EllipsoidOfDualQuadric(const Eigen::Matrix4d& quadric);

// `box_planes` (Nicholson et al. 2019, section III.E; QISO-SLAM): each side of the bounding boxes
// is the image of a plane pi that touches the quadric, pi^T Q* pi = 0. With three observations or
// more these are linear equations for the ten numbers of Q*, whose least-squares solution is the
// singular vector of the least singular value. Observations whose box the border of the image cuts
// are left out if three others remain. The equations are solved about `center` and in units of the
// distance, which does not change their exact solution. Empty if the ellipsoid is not in front of
// all cameras.
std::vector<Ellipsoid> StartByBoxPlanes(const StartInput& input);

}  // namespace hullslam
