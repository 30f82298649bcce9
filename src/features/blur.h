// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam {

// The Gaussian blur of ORB: 7 x 7 px, sigma 2 px, mirrored at the border (BORDER_REFLECT_101). It
// has the same bits as cv::GaussianBlur, in half of its time. Keeps its buffers from image to
// image.
class OrbBlur {
 public:
  // `image` is CV_8UC1 and at least 4 x 4 px; throws CheckError otherwise. The result is valid
  // until the next call.
  const cv::Mat& Blur(const cv::Mat& image);

 private:
  cv::Mat rows_;  // wider than the image, so that its rows are whole blocks
  cv::Mat blurred_;
  // One row after the vertical pass, split into high and low bytes.
  std::vector<uint16_t> high_;
  std::vector<uint16_t> low_;
};

}  // namespace hullslam
