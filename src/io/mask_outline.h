// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam {

// Outlines of the 8-connected parts of a binary image (CV_8UC1, inside is not zero) without holes,
// in its pixels, centres at integer coordinates. They run halfway between the centres of pixels
// inside and outside, through the middles of the edges between them, so that they are biased to
// neither side; at the border of the image they are half a pixel outside.
std::vector<std::vector<Eigen::Vector2d>> FindMaskOutlines(const cv::Mat& mask);

}  // namespace hullslam
