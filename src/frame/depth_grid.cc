// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/depth_grid.h"

#include <algorithm>
#include <cmath>

#include "hullslam/camera/depth.h"

namespace hullslam {
namespace {

constexpr double kFarthest = 65.535;  // m

}  // namespace

DepthGrid::DepthGrid(const cv::Mat& depth, double units_per_metre)
    : columns_((depth.cols + kStep / 2 - 1) / kStep) {
  const int rows = (depth.rows + kStep / 2 - 1) / kStep;
  samples_.reserve(static_cast<size_t>(columns_ * rows));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const auto metres = static_cast<double>(
          SampleDepth(depth, RawPixel(column, row).cast<float>(), units_per_metre));
      samples_.push_back(static_cast<uint16_t>(std::lround(1e3 * std::min(metres, kFarthest))));
    }
  }
}

}  // namespace hullslam
