// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// The solid angle of a polygon of undistorted pixels, steradians; negative if the polygon has a
// negative area. The part of a pixel in it falls with the third power of the cosine of the angle
// from the axis, so areas in the undistorted image of a fisheye lens weigh its rim too much.
double SolidAngle(const PinholeCamera& camera, std::span<const Eigen::Vector2d> polygon);

// Solid angle of the intersection over the one of the union, 0 to 1, of a polygon and a convex one,
// both of positive area; 0 for two empty sets.
double OverlapOnSphere(const PinholeCamera& camera, std::span<const Eigen::Vector2d> polygon,
                       std::span<const Eigen::Vector2d> convex);

}  // namespace hullslam
