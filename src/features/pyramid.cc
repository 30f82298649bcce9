// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "hullslam/util/check.h"
#include "util/function_clones.h"

namespace hullslam {
namespace {

constexpr int kOne = 256;  // the weights are in units of 1 / kOne
constexpr size_t kPixels = ShrinkBlock::kPixels;

using Bytes = uint8_t __attribute__((vector_size(2 * kPixels)));
using Words = uint16_t __attribute__((vector_size(2 * kPixels)));

template <typename Vector>
inline Vector Load(const void* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof(vector));
  return vector;
}

// The pixels at the even bytes of `indices`, as 16-bit numbers.
inline Words Pick(Bytes pixels, Bytes indices) {
#ifdef __clang__
  Words picked{};
  for (size_t i = 0; i < kPixels; ++i) {
    picked[i] = pixels[indices[2 * i]];
  }
  return picked;
#else
  const Bytes picked = __builtin_shuffle(pixels, indices);
  return reinterpret_cast<Words>(picked) & 0xff;
#endif
}

HULLSLAM_FUNCTION_CLONES
void ShrinkRow(const uint8_t* __restrict row, const ShrinkBlock* blocks, size_t count,
               uint16_t* __restrict shrunk) {
  for (size_t i = 0; i < count; ++i) {
    const ShrinkBlock& block = blocks[i];
    const auto pixels = Load<Bytes>(row + block.from);
    const Words first = Pick(pixels, Load<Bytes>(block.first.data()));
    const Words second = Pick(pixels, Load<Bytes>(block.second.data()));
    const Words sum = first * Load<Words>(block.first_weight.data()) +
                      second * Load<Words>(block.second_weight.data());
    std::memcpy(shrunk + kPixels * i, &sum, sizeof(sum));
  }
}

// The weighted sum of two rows, divided by kOne^2 and rounded. High and low bytes are summed
// separately, so 16 bits are enough.
HULLSLAM_FUNCTION_CLONES
void MixRows(const uint16_t* __restrict first, const uint16_t* __restrict second,
             uint16_t second_weight, int width, uint8_t* __restrict mixed) {
  const auto first_weight = static_cast<uint16_t>(kOne - second_weight);
  for (int x = 0; x < width; ++x) {
    const auto high =
        static_cast<uint16_t>(first_weight * (first[x] >> 8) + second_weight * (second[x] >> 8));
    const auto low = static_cast<uint16_t>(first_weight * (first[x] & 0xff) +
                                           second_weight * (second[x] & 0xff));
    mixed[x] = static_cast<uint8_t>(static_cast<uint16_t>(high + (low >> 8) + kOne / 2) >> 8);
  }
}

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

// The source pixels of the centres of all pixels, as in OpenCV.
std::vector<ImageShrinker::Source> ImageShrinker::SourcesOf(int from, int to) {
  const double scale = 1.0 / (static_cast<double>(to) / from);
  std::vector<Source> sources;
  sources.reserve(static_cast<size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double position = scale * (i + 0.5) - 0.5;
    const int first = static_cast<int>(std::floor(position));
    if (first + 1 < from) {
      const auto weight = static_cast<uint16_t>(cvRound(kOne * (position - first)));
      sources.push_back({.first = first, .second_weight = weight});
    } else {
      sources.push_back({.first = from - 2, .second_weight = kOne});
    }
  }
  return sources;
}

// Returns no blocks if the sources of eight pixels can be more than 16 pixels apart.
std::vector<ShrinkBlock> ImageShrinker::BlocksOf(const std::vector<Source>& columns) {
  std::vector<ShrinkBlock> blocks;
  for (size_t x = 0; x < columns.size(); x += kPixels) {
    ShrinkBlock block{.from = columns[x].first};
    for (size_t i = 0; i < kPixels; ++i) {
      const Source& source = columns[std::min(x + i, columns.size() - 1)];
      const int index = source.first - block.from;
      if (index + 1 >= static_cast<int>(2 * kPixels)) {
        return {};
      }
      block.first[2 * i] = static_cast<uint8_t>(index);
      block.second[2 * i] = static_cast<uint8_t>(index + 1);
      block.first_weight[i] = static_cast<uint16_t>(kOne - source.second_weight);
      block.second_weight[i] = source.second_weight;
    }
    blocks.push_back(block);
  }
  return blocks;
}

void ImageShrinker::MakeTables(cv::Size from, cv::Size to) {
  from_ = from;
  to_ = to;
  blocks_.clear();
  if (std::min(from.width, from.height) >= 2) {
    blocks_ = BlocksOf(SourcesOf(from.width, to.width));
    rows_ = SourcesOf(from.height, to.height);
    row_.assign(static_cast<size_t>(from.width) + 2 * kPixels, 0);
    shrunk_rows_.resize(2 * kPixels * blocks_.size());
  }
}

// Row y of the image, shrunk to the new width, in 1/256 grey levels. The rows are asked for from
// top to bottom, so two of them are kept.
const uint16_t* ImageShrinker::ShrunkRow(const cv::Mat& image, int y) {
  const auto slot = static_cast<size_t>(y % 2);
  uint16_t* const shrunk = shrunk_rows_.data() + slot * kPixels * blocks_.size();
  if (shrunk_y_[slot] != y) {
    shrunk_y_[slot] = y;
    std::copy_n(image.ptr(y), image.cols, row_.begin());
    ShrinkRow(row_.data(), blocks_.data(), blocks_.size(), shrunk);
  }
  return shrunk;
}

void ImageShrinker::Shrink(const cv::Mat& image, cv::Size size, cv::Mat& shrunk) {
  Check(image.type() == CV_8UC1, "the image is not CV_8UC1");
  Check(size.width > 0 && size.height > 0, "the image would have no pixel");
  Check(size.width <= image.cols && size.height <= image.rows, "the image would grow");
  if (from_ != image.size() || to_ != size) {
    MakeTables(image.size(), size);
  }
  if (blocks_.empty()) {
    cv::resize(image, shrunk, size, 0.0, 0.0, cv::INTER_LINEAR_EXACT);
    return;
  }
  shrunk.create(size, CV_8UC1);
  shrunk_y_ = {-1, -1};
  for (int y = 0; y < size.height; ++y) {
    const Source& source = rows_[static_cast<size_t>(y)];
    const uint16_t* const first = ShrunkRow(image, source.first);
    const uint16_t* const second = ShrunkRow(image, source.first + 1);
    MixRows(first, second, source.second_weight, size.width, shrunk.ptr(y));
  }
}

ImagePyramid::ImagePyramid(const ScaleLevels& levels)
    : scale_(levels.scale), images_(levels.scale.size()), shrinkers_(levels.scale.size()) {}

void ImagePyramid::Build(const cv::Mat& grey) {
  Check(grey.type() == CV_8UC1, "the image is not CV_8UC1");
  images_[0] = grey;
  for (size_t l = 1; l < images_.size(); ++l) {
    const cv::Size size(cvRound(grey.cols / scale_[l]), cvRound(grey.rows / scale_[l]));
    Check(size.width > 0 && size.height > 0, "the image is too small for the pyramid");
    shrinkers_[l].Shrink(images_[l - 1], size, images_[l]);
  }
}

Eigen::Array2f ImagePyramid::Ratio(int l) const {
  const cv::Mat& image = level(l);
  return {static_cast<float>(images_[0].cols) / static_cast<float>(image.cols),
          static_cast<float>(images_[0].rows) / static_cast<float>(image.rows)};
}

Eigen::Vector2f ImagePyramid::ToLevelZero(const Eigen::Vector2f& pixel, int l) const {
  return (pixel.array() + 0.5f) * Ratio(l) - 0.5f;
}

Eigen::Vector2f ImagePyramid::FromLevelZero(const Eigen::Vector2f& pixel, int l) const {
  return (pixel.array() + 0.5f) / Ratio(l) - 0.5f;
}

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
