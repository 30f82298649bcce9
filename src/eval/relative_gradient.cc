// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/relative_gradient.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace hullslam {

cv::Mat RelativeGradientVectors(const cv::Mat& grey) {
  constexpr double kMost = 200.0;
  std::vector<cv::Mat> parts(2);
  cv::Sobel(grey, parts[0], CV_32F, 1, 0);
  cv::Sobel(grey, parts[1], CV_32F, 0, 1);
  cv::Mat length;
  cv::magnitude(parts[0], parts[1], length);
  cv::Mat factor;
  cv::divide(kMost, cv::max(length, kMost), factor);
  const double mean = cv::mean(cv::min(length, kMost))[0];
  for (cv::Mat& part : parts) {
    part = part.mul(factor, mean > 0.0 ? 1.0 / mean : 1.0);
  }
  cv::Mat gradient;
  cv::merge(parts, gradient);
  return gradient;
}

cv::Mat RelativeGradient(const cv::Mat& grey) {
  std::vector<cv::Mat> parts;
  cv::split(RelativeGradientVectors(grey), parts);
  cv::Mat length;
  cv::magnitude(parts[0], parts[1], length);
  return length;
}

}  // namespace hullslam
