// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace hullslam {

// Images of 16 bits use as many of them as the camera has: 10, 12, 14 or 16, which the largest
// value of all images of the camera tells. The highest of these become the 8 bits that are read;
// what is brighter is white. An image of 8 bits is returned as it is.
cv::Mat To8Bits(const cv::Mat& image, uint16_t brightest);

// The luma of an image in colour, CV_8UC3 or CV_8UC4, as libpng computes it when OpenCV reads a PNG
// in grey: in units of 1 / 32768, rounded down. cv::cvtColor rounds in another way, so that a
// recording would give another trajectory than the PNG files of the same images. `red` is the
// channel of red, 0 or 2.
cv::Mat GreyLikePng(const cv::Mat& image, int red);

}  // namespace hullslam
