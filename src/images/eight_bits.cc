// SPDX-License-Identifier: GPL-3.0-or-later
#include "images/eight_bits.h"

#include <algorithm>
#include <bit>

namespace hullslam {

cv::Mat To8Bits(const cv::Mat& image, uint16_t brightest) {
  if (image.depth() == CV_8U) {
    return image;
  }
  const int bits = std::max(8, (static_cast<int>(std::bit_width(unsigned{brightest})) + 1) / 2 * 2);
  // The lower bits are cut off, as libpng does: the offset makes rounding do this.
  const double scale = 1.0 / (1 << (bits - 8));
  cv::Mat scaled;
  image.convertTo(scaled, CV_8U, scale, 0.5 * scale - 0.5);
  return scaled;
}

cv::Mat GreyLikePng(const cv::Mat& image, int red) {
  constexpr unsigned int kRed = 9797;     // 0.299
  constexpr unsigned int kGreen = 19234;  // 0.587
  constexpr unsigned int kBlue = 32768 - kRed - kGreen;
  cv::Mat grey(image.size(), CV_8UC1);
  const int blue = 2 - red;
  const int channels = image.channels();
  for (int y = 0; y < image.rows; ++y) {
    const uint8_t* pixel = image.ptr<uint8_t>(y);
    auto* const luma = grey.ptr<uint8_t>(y);
    for (int x = 0; x < image.cols; ++x, pixel += channels) {
      luma[x] = static_cast<uint8_t>(
          (kRed * pixel[red] + kGreen * pixel[1] + kBlue * pixel[blue]) >> 15U);
    }
  }
  return grey;
}

}  // namespace hullslam
