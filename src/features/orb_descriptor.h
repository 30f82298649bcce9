// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "hullslam/features/feature_set.h"

namespace hullslam {

// No patch of orientation or descriptor reaches further from its centre, in px.
constexpr int kPatchReach = 19;

// Direction from the centre of a patch to the centroid of its intensity (Rosin 1999), as a unit
// vector in the image (y down).
struct Orientation {
  float cosine = 1.0f;
  float sine = 0.0f;
  float Angle() const;  // radians, 0 to 2 pi
};

// Over the disc of radius 15 px of OpenCV's ORB around `center`, which must be kPatchReach px or
// more inside `image` (CV_8UC1). A patch without direction has angle 0.
Orientation ComputeOrientation(const cv::Mat& image, cv::Point center);

// Steered BRIEF of Rublee et al. 2011 with OpenCV's tests and order of bits: bit i of the
// descriptor is test i. `blurred` is the image (CV_8UC1) after a Gaussian of 7 x 7 px and sigma
// 2 px; `center` as above. Equals OpenCV's ORB but where a rotated test falls within rounding (1e-6
// px) of the border between two pixels.
Descriptor ComputeDescriptor(const cv::Mat& blurred, cv::Point center,
                             const Orientation& orientation);

}  // namespace hullslam
