// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace hullslam {

// The direction with this index (from 0) of `count` unit vectors that are evenly spread over the
// sphere: a Fibonacci lattice. The first half of them has z > 0.
Eigen::Vector3d SphereDirection(int index, int count);

}  // namespace hullslam
