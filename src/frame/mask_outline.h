// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam {

// Outlines of the 8-connected parts of a binary image (CV_8UC1, nonzero is inside), without holes,
// in pixels whose centres are integers. The outlines run halfway between the centres of inside and
// outside pixels, through the middles of the edges, so that they are biased to neither side. At the
// border of the image they are half a pixel outside.
std::vector<std::vector<Eigen::Vector2d>> FindMaskOutlines(const cv::Mat& mask);

}  // namespace hullslam
