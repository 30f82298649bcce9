// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

namespace hullslam {

// The place in a right image that looks like a patch of the left one. All numbers are in pixels of
// the images, which have the same size (one level of their pyramids).
struct PatchFit {
  float column = 0.0F;
  float difference = 0.0F;  // mean absolute difference of the patches, grey levels
};

// Finds the patch about the pixel `at` of `left` in the same row of `right`, near the column
// `column`. First the patch is shifted by whole pixels; then the fit of least squares moves it by
// fractions of a pixel (Lucas and Kanade 1981):
//   sum over pixels p of  weight(p) (right(p + shift) - gain left(p) - offset)^2
// is smallest. A parabola through the differences at whole pixels is wrong by a tenth of a pixel.
//
// Nothing if one of the patches reaches the border of its image, or if the best shift is the last
// one that was tried, because a better one may lie beyond. Both images are CV_8UC1.
std::optional<PatchFit> FitPatch(const cv::Mat& left, cv::Point at, const cv::Mat& right,
                                 int column);

}  // namespace hullslam
