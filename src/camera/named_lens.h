// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// Sets the lens of the camera from the coefficients of a model by the name that calibration files
// and messages give it, in upper or lower case:
// - plumb_bob (ROS), radtan (Kalibr), radtan4, radtan5, radial-tangential (EuRoC), Brown Conrady
//   (librealsense): k1 k2 p1 p2 and perhaps k3;
// - rational_polynomial (ROS), opencv: the same with k4 k5 k6 after k3;
// - equidistant (Kalibr, ROS), fisheye (OpenCV, stella_vslam), kannala_brandt, KannalaBrandt8
//   (ORB-SLAM3): k1 k2 k3 k4;
// - ds (Kalibr, Basalt), double_sphere: xi alpha; eucm: alpha beta.
// Further coefficients may be given if they are 0, and any other model, or none, if all are 0.
// Returns what was expected instead, or nothing if the lens was set.
std::string SetNamedLens(std::string_view model, std::span<const double> coefficients,
                         PinholeCamera& camera);

// The same for Kalibr's and Basalt's intrinsics: the focal lengths of the camera, which must be
// set before, become those on the axis of a double sphere.
std::string SetLensOfKalibr(std::string_view model, std::span<const double> coefficients,
                            PinholeCamera& camera);

// The lens as messages and calibrations of ROS have it: plumb_bob with five coefficients,
// rational_polynomial with eight, or a wide lens.
struct NamedLens {
  std::string_view model;
  std::vector<double> coefficients;
};
NamedLens LensOfRos(const PinholeCamera& camera);

// "without distortion", "with radial-tangential distortion", "with rational distortion" or, for
// example, "with a fisheye lens (Kannala-Brandt)".
std::string DescribeLens(const PinholeCamera& camera);

}  // namespace hullslam
