// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "camera/wide_lens.h"
#include "hullslam/camera/pinhole.h"

namespace hullslam {

// LensModel::kBrown at a point of the plane z = 1.
LensPoint DistortBrown(const PinholeCamera& camera, const Eigen::Vector2d& point);

// The coefficients in OpenCV's order: k1, k2, p1, p2, k3 to k6. Zeros for another lens.
std::array<double, 8> BrownCoefficients(const PinholeCamera& camera);

// The point that DistortBrown() maps to `target`; at a fold the best point found.
Eigen::Vector2d UndistortBrown(const PinholeCamera& camera, const Eigen::Vector2d& target);

// The distorted radius at which the radial factor folds; infinite if it does not before 89 degrees
// from the axis.
double FoldOfBrown(const PinholeCamera& camera);

}  // namespace hullslam
