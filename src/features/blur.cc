// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/blur.h"

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>

#include "hullslam/util/check.h"
#include "util/function_clones.h"

namespace hullslam {
namespace {

constexpr int kRadius = 3;
constexpr int kRows = 2 * kRadius + 1;
constexpr int kBlurBlock = 32;  // px; rows are blurred in whole blocks, without a slow remainder

// The weights of OpenCV for 8-bit images, in 1/256, from the centre outwards. They sum to 256.
constexpr std::array<uint16_t, kRadius + 1> kWeights = {56, 48, 34, 18};

// A weighted sum of bytes. It is at most 256 * 255, so 16 bits are enough.
inline uint16_t WeightedSum(uint16_t a, uint16_t b, uint16_t c, uint16_t center, uint16_t d,
                            uint16_t e, uint16_t f) {
  return static_cast<uint16_t>(kWeights[0] * center + kWeights[1] * static_cast<uint16_t>(c + d) +
                               kWeights[2] * static_cast<uint16_t>(b + e) +
                               kWeights[3] * static_cast<uint16_t>(a + f));
}

using RowsAround = std::array<const uint8_t*, kRows>;

// The vertical pass: the high and the low bytes of the weighted sums of seven pixels.
HULLSLAM_FUNCTION_CLONES
void BlurColumns(const RowsAround& rows, int width, uint16_t* __restrict high,
                 uint16_t* __restrict low) {
  const auto [a, b, c, center, d, e, f] = rows;
  for (int x = 0; x < width; ++x) {
    const uint16_t sum = WeightedSum(a[x], b[x], c[x], center[x], d[x], e[x], f[x]);
    high[x] = static_cast<uint16_t>(sum >> 8);
    low[x] = static_cast<uint16_t>(sum & 0xff);
  }
}

inline uint16_t SumAcross(const uint16_t* first) {
  return WeightedSum(first[0], first[1], first[2], first[3], first[4], first[5], first[6]);
}

// The horizontal pass. The blurred pixel is (256 H + L + 2^15) / 2^16, rounded down, where H and L
// are the weighted sums of the high and of the low bytes. This form of it needs only 16 bits.
HULLSLAM_FUNCTION_CLONES
void BlurRow(const uint16_t* __restrict high, const uint16_t* __restrict low, int blocks,
             uint8_t* __restrict blurred) {
  for (int x = 0; x < blocks * kBlurBlock; ++x) {
    const auto carry = static_cast<uint16_t>((SumAcross(low + x) >> 8) + 128);
    blurred[x] = static_cast<uint8_t>(static_cast<uint16_t>(SumAcross(high + x) + carry) >> 8);
  }
}

// Continues a row of `width` px, which begins at kRadius, on both sides.
void Mirror(std::vector<uint16_t>& row, int width) {
  uint16_t* const first = row.data() + kRadius;
  uint16_t* const last = first + width - 1;
  for (int i = 1; i <= kRadius; ++i) {
    first[-i] = first[i];
    last[i] = last[-i];
  }
}

}  // namespace

const cv::Mat& OrbBlur::Blur(const cv::Mat& image) {
  Check(image.type() == CV_8UC1, "the image is not CV_8UC1");
  Check(image.cols > kRadius && image.rows > kRadius, "the image is smaller than 4 x 4 px");
  const int blocks = (image.cols + kBlurBlock - 1) / kBlurBlock;
  rows_.create(image.rows, blocks * kBlurBlock, CV_8UC1);
  const auto padded = static_cast<size_t>(blocks * kBlurBlock + 2 * kRadius);
  high_.resize(padded);
  low_.resize(padded);
  for (int y = 0; y < image.rows; ++y) {
    RowsAround around;
    for (int i = 0; i < kRows; ++i) {
      const int row = cv::borderInterpolate(y + i - kRadius, image.rows, cv::BORDER_REFLECT_101);
      around[static_cast<size_t>(i)] = image.ptr(row);
    }
    BlurColumns(around, image.cols, high_.data() + kRadius, low_.data() + kRadius);
    Mirror(high_, image.cols);
    Mirror(low_, image.cols);
    BlurRow(high_.data(), low_.data(), blocks, rows_.ptr(y));
  }
  blurred_ = rows_.colRange(0, image.cols);
  return blurred_;
}

}  // namespace hullslam
