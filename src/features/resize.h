// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

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

}  // namespace hullslam
