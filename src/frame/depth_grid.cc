// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/depth_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hullslam/camera/depth.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

constexpr double kFarthest = 65.535;  // m

}  // namespace

DepthGrid::DepthGrid(const cv::Mat& depth, double units_per_metre)
    : columns_(CountAlong(depth.cols)) {
  const int rows = CountAlong(depth.rows);
  samples_.reserve(static_cast<size_t>(columns_ * rows));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const auto metres = static_cast<double>(
          SampleDepth(depth, RawPixel(column, row).cast<float>(), units_per_metre));
      samples_.push_back(static_cast<uint16_t>(std::lround(1e3 * std::min(metres, kFarthest))));
    }
  }
}

DepthGrid::DepthGrid(int columns, std::vector<uint16_t> samples)
    : columns_(columns), samples_(std::move(samples)) {
  Check(columns >= 0 && (samples_.empty() ||
                         (columns > 0 && samples_.size() % static_cast<size_t>(columns) == 0)),
        "the samples do not fill the rows of the grid");
}

}  // namespace hullslam
