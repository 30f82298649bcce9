// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>

namespace hullslam {

// The magnitude of the gradient of an image (CV_8UC1), divided by its mean: CV_32FC1. Strong edges
// are limited, so that a few of them do not decide what is measured with it.
cv::Mat RelativeGradient(const cv::Mat& grey);

// The same with directions, CV_32FC2.
cv::Mat RelativeGradientVectors(const cv::Mat& grey);

}  // namespace hullslam
