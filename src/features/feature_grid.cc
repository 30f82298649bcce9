// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/feature_grid.h"

#include <cmath>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// Converts a distance from the edge of the box, in cells, to a cell number within the grid. The
// comparison is done before the conversion, so that far, infinite and NaN values do not overflow
// the integer.
int ClampedCell(float cells, int count) {
  if (!(cells > 0.0f)) {
    return 0;
  }
  return cells < static_cast<float>(count) ? static_cast<int>(cells) : count - 1;
}

}  // namespace

FeatureGrid::FeatureGrid(std::span<const Keypoint> keypoints, const Eigen::Vector2f& box_min,
                         const Eigen::Vector2f& box_max)
    : min_(box_min) {
  Check((box_max.array() > box_min.array()).all(), "the box of the image is empty");
  cells_per_pixel_ = Eigen::Array2f(kColumns, kRows) / (box_max - box_min).array();
  std::vector<uint32_t> cells;
  cells.reserve(keypoints.size());
  for (const Keypoint& keypoint : keypoints) {
    const Eigen::Array2f position =
        (keypoint.undistorted - min_).array() * cells_per_pixel_.array();
    cells.push_back(static_cast<uint32_t>(ClampedCell(position.x(), kColumns) * kRows +
                                          ClampedCell(position.y(), kRows)));
  }
  cell_start_.assign(kColumns * kRows + 1, 0);
  for (const uint32_t cell : cells) {
    ++cell_start_[cell + 1];
  }
  for (size_t c = 1; c < cell_start_.size(); ++c) {
    cell_start_[c] += cell_start_[c - 1];
  }
  std::vector<uint32_t> next(cell_start_.begin(), cell_start_.end() - 1);
  order_.resize(keypoints.size());
  for (size_t i = 0; i < cells.size(); ++i) {
    order_[next[cells[i]]++] = static_cast<uint32_t>(i);
  }
}

void FeatureGrid::FindNear(std::span<const Keypoint> keypoints, const Eigen::Vector2f& center,
                           float radius, int min_level, int max_level,
                           std::vector<uint32_t>& found) const {
  if (order_.empty()) {
    return;
  }
  const Eigen::Array2f low = (center - min_).array() - radius;
  const Eigen::Array2f high = (center - min_).array() + radius;
  const int first_column = ClampedCell(low.x() * cells_per_pixel_.x(), kColumns);
  const int last_column = ClampedCell(high.x() * cells_per_pixel_.x(), kColumns);
  const int first_row = ClampedCell(low.y() * cells_per_pixel_.y(), kRows);
  const int last_row = ClampedCell(high.y() * cells_per_pixel_.y(), kRows);
  for (int column = first_column; column <= last_column; ++column) {
    // The cells of a column are stored one after another, so the wanted rows form one contiguous
    // range.
    const uint32_t begin = cell_start_[static_cast<size_t>(column * kRows + first_row)];
    const uint32_t end = cell_start_[static_cast<size_t>(column * kRows + last_row + 1)];
    for (uint32_t i = begin; i < end; ++i) {
      const Keypoint& keypoint = keypoints[order_[i]];
      if (keypoint.level >= min_level && keypoint.level <= max_level &&
          std::abs(keypoint.undistorted.x() - center.x()) < radius &&
          std::abs(keypoint.undistorted.y() - center.y()) < radius) {
        found.push_back(order_[i]);
      }
    }
  }
}

}  // namespace hullslam
