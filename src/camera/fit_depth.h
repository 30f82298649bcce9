// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>

namespace hullslam {

// Whether a depth image can be that of a colour image of another size: their ratios of width to
// height agree to 1 %. ScanNet has 640x480 beside 1296x968 px, which differ by 0.4 %.
bool HaveSameShape(const cv::Size& depth, const cv::Size& colour);

// The depth image (CV_16UC1 or CV_32FC1) at another size, as if each of its pixels covered a part
// of the colour image. Between four pixels of one surface the inverse depth is interpolated, which
// is exact on planes. Where the four are not of one surface, or not all known, it is that of the
// nearest pixel, so foreground and background are never mixed. An image of this size is returned as
// it is.
cv::Mat FitDepth(const cv::Mat& depth, const cv::Size& size);

// The depth image with the true disparities bf / z, if all of it are too large by `offset` (px).
// Depths whose true disparity is not positive become unknown. `bf` is in m px. The image itself if
// the offset is 0.
cv::Mat WithoutDisparityOffset(const cv::Mat& depth, double offset, double bf,
                               double units_per_metre);

}  // namespace hullslam
