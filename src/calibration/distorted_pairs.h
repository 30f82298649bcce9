// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// Points that two images of one camera see, raw pixels; some may be wrong.
struct DistortedPair {
  std::vector<Eigen::Vector2d> a;
  std::vector<Eigen::Vector2d> b;
};

// The radial distortion with which most pairs of images agree with a motion of the camera, whatever
// its focal length: undistorted points have a fundamental matrix, distorted ones have none. It is
// the number l of the division model (Fitzgibbon 2001),
//   r_u = r_d / (1 + l r_d^2),
// with distances r from the middle of the image in halves of its diagonal; negative for lenses
// whose image is like a barrel. The cost of all pairs together is smallest at the result. Null if
// no pair has enough points.
std::optional<double> RadialDistortionOf(std::span<const DistortedPair> pairs, int width,
                                         int height);

// Sets the coefficients k1 and k2 of Brown's lens that are most like this division model, for the
// focal length and the size of the camera.
void SetDivisionModel(double distortion, PinholeCamera& camera);

}  // namespace hullslam
