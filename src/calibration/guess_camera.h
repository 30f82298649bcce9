// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "calibration/recorded_camera.h"
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

// The camera of `options` with a radial distortion and a focal length that fit a recording. Of the
// intrinsics only the size of the image is used. The distortion is estimated from pairs of images
// all over the recording (RadialDistortionOf). Then SLAM runs on the first frames with this
// distortion and fields of view from 45 to 100 degrees, and the lens is calibrated from each. The
// one with which most points are seen in most images, with the smallest errors, wins. Any of
// them if it is cancelled. Throws InputError if SLAM fails with all of them.
PinholeCamera GuessCamera(SystemOptions options, const CameraRecording& recording,
                          const RecordedCalibrationOptions& calibration);

}  // namespace hullslam
