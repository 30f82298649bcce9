// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "camera/lens_point.h"
#include "hullslam/camera/pinhole.h"

namespace hullslam {

// LensModel::kKannalaBrandt at a point of the plane z = 1.
LensPoint DistortKannalaBrandt(const PinholeCamera& camera, const Eigen::Vector2d& point);

// The distorted radius of a ray at this angle from the axis, radians.
double RadiusOfAngle(const PinholeCamera& camera, double angle);

// The largest angle, at most `limit`, up to which the distorted radius grows with the angle.
double LargestAngle(const PinholeCamera& camera, double limit);

// The angle whose distorted radius is `radius`; at most `largest`, which LargestAngle() gave.
double AngleOfRadius(const PinholeCamera& camera, double radius, double largest);

// The point that DistortKannalaBrandt() maps to `target`, at most at PinholeCamera::kMostAngle.
Eigen::Vector2d UndistortKannalaBrandt(const PinholeCamera& camera, const Eigen::Vector2d& target);

// The distorted radius at which the model folds; infinite if it does not up to 180 degrees from the
// axis.
double FoldOfKannalaBrandt(const PinholeCamera& camera);

// The unit ray of a raw pixel, at most at the angle `largest`, which LargestAngle() gave.
Eigen::Vector3d RayOfRawPixel(const PinholeCamera& camera, const Eigen::Vector2d& raw,
                              double largest);

// The raw pixel of a ray of any length and direction.
Eigen::Vector2d RawPixelOfRay(const PinholeCamera& camera, const Eigen::Vector3d& ray);

}  // namespace hullslam
