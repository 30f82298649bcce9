// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <map>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam {

constexpr double kSmallestOutlineArea = 1.0;  // px^2

// Sorts outlines by area, the largest first, and removes those smaller than kSmallestOutlineArea.
void SortByArea(std::vector<std::vector<Eigen::Vector2d>>& outlines);

// Outlines of the 8-connected parts of a binary image (CV_8UC1, nonzero is inside), without their
// holes and what is in them. In their coordinates (px) the centres of pixels are integers. The
// outlines pass through the middles of the edges between inside and outside pixels, halfway between
// the two centres, so their size has no bias. At the border of the image they are half a pixel
// outside. The first part from above is the last outline.
std::vector<std::vector<Eigen::Vector2d>> FindMaskOutlines(const cv::Mat& mask);

// The same for the pixels of each number but 0 in a label image: CV_8UC1, CV_16UC1 or CV_32SC1. The
// time is linear in the pixels, however many numbers there are.
std::map<int, std::vector<std::vector<Eigen::Vector2d>>> FindLabelOutlines(const cv::Mat& labels);

}  // namespace hullslam
