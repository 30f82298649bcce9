// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "hullslam/features/feature_set.h"

namespace hullslam {

// The orientation and the descriptor read only pixels within this distance of the centre, px.
constexpr int kPatchReach = 19;

// The direction from the centre of a patch to the centroid of its intensity (Rosin 1999), as a unit
// vector in the image (y down).
struct Orientation {
  float cosine = 1.0f;
  float sine = 0.0f;
  float Angle() const;  // radians, 0 to 2 pi
};

// Uses the disc of radius 15 px of OpenCV's ORB around `center`, which must be at least kPatchReach
// px inside `image` (CV_8UC1). A patch without a direction has angle 0.
Orientation ComputeOrientation(const cv::Mat& image, cv::Point center);

// Steered BRIEF of Rublee et al. 2011, with the tests and the order of bits of OpenCV: bit i of the
// descriptor is the result of test i. `blurred` is the image (CV_8UC1) after a Gaussian blur of 7 x
// 7 px with sigma 2 px; `center` as above. The result equals OpenCV's ORB, except if a
// rotated test point lies within rounding (1e-6 px) of the border between two pixels.
Descriptor ComputeDescriptor(const cv::Mat& blurred, cv::Point center,
                             const Orientation& orientation);

}  // namespace hullslam
