// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam {

// Outlines of the 8-connected parts of a binary image (CV_8UC1, nonzero is inside), without their
// holes. In their coordinates (px) the centres of pixels are integers. The outlines pass through
// the middles of the edges between inside and outside pixels, halfway between the two centres, so
// their size has no bias. At the border of the image they are half a pixel outside.
std::vector<std::vector<Eigen::Vector2d>> FindMaskOutlines(const cv::Mat& mask);

}  // namespace hullslam
