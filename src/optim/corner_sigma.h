// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// How well a pose is determined, in px (raw px of a fisheye lens): the standard deviation with
// which it places a point at `depth` (z in the camera frame) in the direction in which it is
// largest, in that corner of the raw image in which it is largest. A corner beyond the largest
// angle of a fisheye lens counts as the last pixel on the way to it. `information` is the inverse
// covariance of the pose by the six parameters of Retract (JointPoseResult::information). Infinite
// if it cannot be inverted.
//
// A step (w, v) of the pose moves a point x of the camera frame by -[x]_x w + v. With J, the
// derivative of the pixel by the step, the covariance of the pixel is J information^-1 J^T. It does
// not depend on the unit of length. It is large if the landmarks of the pose are few, or if they
// are all in one small part of the image or along one line: they fix the pose there and let it
// turn elsewhere.
double CornerSigma(const PinholeCamera& camera, const Eigen::Matrix<double, 6, 6>& information,
                   double depth);

}  // namespace hullslam
