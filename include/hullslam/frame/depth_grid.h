// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam {

// The depth image at every kStep-th pixel of every kStep-th row. Keyframes keep it, so that later
// steps can find out whether something hid an object, and whether a landmark is still there.
class DepthGrid {
 public:
  static constexpr int kStep = 8;  // px

  DepthGrid() = default;
  // `depth` as in ImageInput; an empty image gives an empty grid.
  DepthGrid(const cv::Mat& depth, double units_per_metre);
  // A grid that was stored: its samples() and its number of columns. Throws CheckError if the
  // samples do not fill the rows.
  DepthGrid(int columns, std::vector<uint16_t> samples);

  bool empty() const { return samples_.empty(); }
  int columns() const { return columns_; }
  int rows() const { return empty() ? 0 : static_cast<int>(samples_.size()) / columns_; }
  // Depth at the sample, m; 0 if it is unknown.
  double At(int column, int row) const {
    return 1e-3 * samples_[static_cast<size_t>(row * columns_ + column)];
  }
  // All samples in mm, row by row; 0 for unknown.
  const std::vector<uint16_t>& samples() const { return samples_; }
  // Number of columns or rows of the grid of an image with this width or height (px).
  static int CountAlong(int side) { return (side + kStep / 2 - 1) / kStep; }
  // Raw pixel of a sample.
  static Eigen::Vector2d RawPixel(int column, int row) {
    return {kStep * column + kStep / 2, kStep * row + kStep / 2};
  }

 private:
  int columns_ = 0;
  std::vector<uint16_t> samples_;  // mm, row by row; 0 for unknown
};

}  // namespace hullslam
