// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

#include "hullslam/features/feature_set.h"

namespace hullslam {

// The indices and weights by which eight neighbouring pixels of a shrunk row are computed from 16
// pixels of the row.
struct ShrinkBlock {
  static constexpr size_t kPixels = 8;
  using Bytes = std::array<uint8_t, 2 * kPixels>;
  using Words = std::array<uint16_t, kPixels>;

  int from = 0;  // index of the first of the 16 pixels in their row
  // Each pixel is a weighted sum of two of the 16. The indices are 16-bit numbers, as bytes.
  alignas(16) Bytes first{};
  alignas(16) Bytes second{};
  alignas(16) Words first_weight{};  // in 1/256
  alignas(16) Words second_weight{};
};

// Makes images smaller by linear interpolation. It has the same bits as cv::resize with
// INTER_LINEAR_EXACT, in a third of its time. Keeps tables and buffers from image to image.
class ImageShrinker {
 public:
  // `image` is CV_8UC1, and no side of `size` is larger than in the image; throws CheckError
  // otherwise. Reuses the memory of `shrunk` if it has the size already.
  void Shrink(const cv::Mat& image, cv::Size size, cv::Mat& shrunk);

 private:
  // A pixel of a row or of a column is a weighted sum of the pixels `first` and `first + 1`.
  struct Source {
    int first;
    uint16_t second_weight;  // in 1/256
  };
  static std::vector<Source> SourcesOf(int from, int to);
  static std::vector<ShrinkBlock> BlocksOf(const std::vector<Source>& columns);
  void MakeTables(cv::Size from, cv::Size to);
  const uint16_t* ShrunkRow(const cv::Mat& image, int y);

  cv::Size from_;
  cv::Size to_;
  std::vector<ShrinkBlock> blocks_;  // empty if the image shrinks too much for blocks
  std::vector<Source> rows_;
  std::vector<uint8_t> row_;           // a row of the image, and room to read beyond its end
  std::vector<uint16_t> shrunk_rows_;  // two rows; row y is the first if y is even, else the second
  std::array<int, 2> shrunk_y_{-1, -1};  // the numbers of these rows
};

// Copies of an image at decreasing sizes. Keeps its buffers from image to image.
class ImagePyramid {
 public:
  explicit ImagePyramid(const ScaleLevels& levels);

  // Level 0 shares the pixels of `grey` (CV_8UC1), which must stay alive as long as level 0 is
  // used. Level l has the size of level 0 divided by scale[l], rounded, as in the ORB of OpenCV,
  // and is resized from level l - 1. Throws CheckError if a level would have no pixel.
  void Build(const cv::Mat& grey);

  const cv::Mat& level(int l) const { return images_[static_cast<size_t>(l)]; }

  // Maps a pixel of level l to level 0. Sizes are rounded, and the centre of a pixel has integer
  // coordinates, so this is (p + 1/2) size_0 / size_l - 1/2. The formula p scale_l of ORB-SLAM2 is
  // wrong by more than a pixel at the upper levels.
  Eigen::Vector2f ToLevelZero(const Eigen::Vector2f& pixel, int l) const;
  // Maps a pixel of level 0 to level l.
  Eigen::Vector2f FromLevelZero(const Eigen::Vector2f& pixel, int l) const;

 private:
  Eigen::Array2f Ratio(int l) const;  // size of level 0 / size of level l

  std::vector<float> scale_;
  std::vector<cv::Mat> images_;
  std::vector<ImageShrinker> shrinkers_;  // one per level; the first is not used
};

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
