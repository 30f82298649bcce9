// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// The part of a convex polygon of undistorted pixels that is in the image, whose undistorted bounds
// are `image`. A fisheye image is no box after undistortion, so there the polygon is cut in the raw
// image, and the result is the convex hull of what is left, as that of a mask is. A polygon that
// the image does not cut stays as it is.
std::vector<Eigen::Vector2d> VisiblePart(const std::vector<Eigen::Vector2d>& polygon,
                                         const PinholeCamera& camera,
                                         const Eigen::AlignedBox2d& image);

}  // namespace hullslam
