// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <map>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

namespace hullslam {

constexpr double kSmallestOutlineArea = 1.0;  // px^2

// The bounding box of each number but 0 in a label image: CV_8UC1, CV_16UC1 or CV_32SC1.
std::map<int, cv::Rect> FindInstances(const cv::Mat& labels);

// The outlines of the pixels that have this number, as from FindMaskOutlines(). `box` is their
// bounding box.
std::vector<std::vector<Eigen::Vector2d>> OutlinesOf(const cv::Mat& labels, int number,
                                                     const cv::Rect& box);

// Sorts outlines by area, the largest first, and removes those smaller than kSmallestOutlineArea.
void SortByArea(std::vector<std::vector<Eigen::Vector2d>>& outlines);

}  // namespace hullslam
