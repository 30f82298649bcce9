// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// A distorted point of the plane z = 1, and its derivative by the undistorted point.
struct LensPoint {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;
};

// Lenses that see more than half of the space in front of them. In all of them the image of a ray
// is at a radius that depends only on its angle from the axis. A further one is a
// LensModel and a row in wide_lens.cc.

// The distorted radius of a ray at an angle from the axis (radians), on the plane z = 1, and its
// derivative by the angle.
struct LensRadius {
  double radius = 0.0;
  double slope = 1.0;
};

// A coefficient of a lens.
struct LensCoefficient {
  std::string_view name;  // of the key Camera.NAME
  double PinholeCamera::*field;
};

// What HullSLAM knows of a wide lens.
struct WideModel {
  LensModel lens;
  std::string_view type;   // the value of Camera.type
  std::string_view title;  // "a fisheye lens (Kannala-Brandt)"
  // In calibration files, in lower case; messages of ROS have the first one.
  std::span<const std::string_view> names;
  std::span<const LensCoefficient> coefficients;  // in the order of calibration files
  LensRadius (*radius)(const PinholeCamera& camera, double angle);
  double (*largest)(const PinholeCamera& camera, double limit);  // see LargestAngle()
};
std::span<const WideModel> WideModels();  // in the order of LensModel
// The coefficients of any lens. Those of Brown's are in OpenCV's order: k1, k2, p1, p2, k3 to k6.
std::span<const LensCoefficient> CoefficientsOf(LensModel lens);
// The values of Camera.type in the order of LensModel: "PinHole", then those of WideModels().
std::vector<std::string> LensTypes();
// Null for a pinhole, and for a name that no model has in `names`, in upper or lower case.
const WideModel* FindWideModel(LensModel lens);
const WideModel* FindWideModel(std::string_view name);

LensRadius RadiusAt(const PinholeCamera& camera, double angle);
inline double RadiusOfAngle(const PinholeCamera& camera, double angle) {
  return RadiusAt(camera, angle).radius;
}

// The distorted point of a point of the plane z = 1.
LensPoint DistortWide(const PinholeCamera& camera, const Eigen::Vector2d& point);

// The largest angle, at most `limit`, up to which the distorted radius grows with the angle.
double LargestAngle(const PinholeCamera& camera, double limit);

// The angle whose distorted radius is `radius`; at most `largest`, which LargestAngle() gave.
double AngleOfRadius(const PinholeCamera& camera, double radius, double largest);

// The point that DistortWide() maps to `target`, at most at PinholeCamera::kMostAngle.
Eigen::Vector2d UndistortWide(const PinholeCamera& camera, const Eigen::Vector2d& target);

// The distorted radius at which the lens folds; infinite if it does not up to 180 degrees from the
// axis.
double FoldOfWide(const PinholeCamera& camera);

// The unit ray of a raw pixel, at most at the angle `largest`, which LargestAngle() gave.
Eigen::Vector3d RayOfRawPixel(const PinholeCamera& camera, const Eigen::Vector2d& raw,
                              double largest);

// The raw pixel of a ray of any length and direction.
Eigen::Vector2d RawPixelOfRay(const PinholeCamera& camera, const Eigen::Vector3d& ray);

}  // namespace hullslam
