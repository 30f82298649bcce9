// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/relative_gradient.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace hullslam {

cv::Mat RelativeGradient(const cv::Mat& grey) {
  constexpr double kMost = 200.0;
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(grey, dx, CV_32F, 1, 0);
  cv::Sobel(grey, dy, CV_32F, 0, 1);
  cv::Mat gradient;
  cv::magnitude(dx, dy, gradient);
  gradient = cv::min(gradient, kMost);
  const double mean = cv::mean(gradient)[0];
  return mean > 0.0 ? cv::Mat(gradient / mean) : gradient;
}

}  // namespace hullslam
