// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/coarse_depth.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hullslam {
namespace {

constexpr double kNearest = 4.0;  // baselines
constexpr int kBlock = 5;         // px; side of the compared blocks
// Penalties of Hirschmüller for disparities of neighbours that differ by one and by more, per pixel
// of a block; the factors are those that OpenCV's documentation recommends.
constexpr int kSmallStep = 8 * kBlock * kBlock;
constexpr int kLargeStep = 32 * kBlock * kBlock;

// The number of disparities that must be tried in the images of half the size; a multiple of 16.
int DisparityCount(const PinholeCamera& camera, int width) {
  const double largest = 0.5 * camera.fx / kNearest;
  const int count = 16 * static_cast<int>(std::ceil(largest / 16.0));
  return std::clamp(count, 16, std::max(16, width / 2 / 16 * 16));
}

}  // namespace

cv::Mat CoarseDepth(const cv::Mat& left, const cv::Mat& right, const PinholeCamera& camera) {
  constexpr double kPerPixel = 16.0;  // units of OpenCV's disparities
  cv::Mat small_left;
  cv::Mat small_right;
  cv::resize(left, small_left, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::resize(right, small_right, {}, 0.5, 0.5, cv::INTER_AREA);
  const auto matcher =
      cv::StereoSGBM::create(0, DisparityCount(camera, small_left.cols), kBlock, kSmallStep,
                             kLargeStep, 1, 31, 10, 60, 2, cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat disparities;
  matcher->compute(small_left, small_right, disparities);
  cv::Mat depth(left.size(), CV_32FC1);
  const double scale =
      static_cast<double>(left.cols) / static_cast<double>(small_left.cols) / kPerPixel;
  for (int y = 0; y < depth.rows; ++y) {
    const auto* const row = disparities.ptr<int16_t>(std::min(y / 2, disparities.rows - 1));
    for (int x = 0; x < depth.cols; ++x) {
      const int disparity = row[std::min(x / 2, disparities.cols - 1)];
      depth.at<float>(y, x) =
          disparity > 0 ? static_cast<float>(camera.bf / (scale * disparity)) : 0.0F;
    }
  }
  return depth;
}

}  // namespace hullslam
