// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/feature_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

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

template <typename Value>
std::vector<Value> Select(const std::vector<Value>& values, std::span<const uint32_t> kept) {
  std::vector<Value> selected;
  selected.reserve(kept.size());
  for (const uint32_t index : kept) {
    selected.push_back(values.at(index));
  }
  return selected;
}

}  // namespace

int FeatureGrid::Column(float x) const {
  return ClampedCell((x - min_.x()) * cells_per_pixel_.x(), kColumns);
}

int FeatureGrid::Row(float y) const {
  return ClampedCell((y - min_.y()) * cells_per_pixel_.y(), kRows);
}

FeatureGrid::FeatureGrid(std::span<const Keypoint> keypoints, const Eigen::Vector2f& box_min,
                         const Eigen::Vector2f& box_max)
    : min_(box_min) {
  Sort(keypoints, box_max);
}

FeatureGrid::FeatureGrid(std::span<const Keypoint> keypoints,
                         std::vector<Eigen::Vector2f> positions, const Eigen::Vector2f& box_max)
    : positions_(std::move(positions)) {
  Check(positions_.size() == keypoints.size(), "there must be one position per keypoint");
  Sort(keypoints, box_max);
}

void FeatureGrid::Sort(std::span<const Keypoint> keypoints, const Eigen::Vector2f& box_max) {
  Check((box_max.array() > min_.array()).all(), "the box of the image is empty");
  Check(keypoints.size() <= std::numeric_limits<uint16_t>::max(), "too many keypoints for a grid");
  cells_per_pixel_ = Eigen::Array2f(kColumns, kRows) / (box_max - min_).array();
  std::vector<uint16_t> cells;
  cells.reserve(keypoints.size());
  cell_start_.assign(kColumns * kRows + 1, 0);
  for (uint32_t i = 0; i < keypoints.size(); ++i) {
    const Eigen::Vector2f position = PositionOf(keypoints, i);
    const int cell = Column(position.x()) * kRows + Row(position.y());
    cells.push_back(static_cast<uint16_t>(cell));
    ++cell_start_[static_cast<size_t>(cell) + 1];
  }
  std::partial_sum(cell_start_.begin(), cell_start_.end(), cell_start_.begin());
  order_.resize(keypoints.size());
  std::vector<uint16_t> next(cell_start_);
  for (size_t i = 0; i < cells.size(); ++i) {
    order_[next[cells[i]]++] = static_cast<uint16_t>(i);
  }
}

FeatureGrid FeatureGrid::Select(std::span<const uint32_t> kept) const {
  if (order_.empty()) {
    return *this;
  }
  constexpr uint16_t kRemoved = std::numeric_limits<uint16_t>::max();
  std::vector<uint16_t> new_index(order_.size(), kRemoved);
  for (size_t i = 0; i < kept.size(); ++i) {
    new_index.at(kept[i]) = static_cast<uint16_t>(i);
  }
  FeatureGrid selected;
  selected.min_ = min_;
  selected.cells_per_pixel_ = cells_per_pixel_;
  for (size_t i = 0; i < kept.size() && !positions_.empty(); ++i) {
    selected.positions_.push_back(positions_.at(kept[i]));
  }
  selected.order_.reserve(kept.size());
  selected.cell_start_.reserve(cell_start_.size());
  size_t position = 0;
  for (const uint16_t start : cell_start_) {
    for (; position < start; ++position) {
      if (const uint16_t index = new_index[order_[position]]; index != kRemoved) {
        selected.order_.push_back(index);
      }
    }
    selected.cell_start_.push_back(static_cast<uint16_t>(selected.order_.size()));
  }
  return selected;
}

GridSearch::GridSearch(const FeatureGrid& grid, std::span<const Keypoint> keypoints)
    : grid_(grid), found_(keypoints.size() + 1) {
  places_.reserve(keypoints.size());
  for (const uint16_t index : grid.order_) {
    places_.push_back({grid.PositionOf(keypoints, index), keypoints[index].level, index});
  }
}

// Most keypoints of a cell are not in the window, in no order that a branch could be predicted
// from.
std::span<const uint32_t> GridSearch::FindNear(const Eigen::Vector2f& center, float radius,
                                               int min_level, int max_level) {
  if (places_.empty()) {
    return {};
  }
  size_t count = 0;
  const int last_column = grid_.Column(center.x() + radius);
  const int first_row = grid_.Row(center.y() - radius);
  const int last_row = grid_.Row(center.y() + radius);
  for (int column = grid_.Column(center.x() - radius); column <= last_column; ++column) {
    const uint16_t* const cell = grid_.cell_start_.data() + column * FeatureGrid::kRows;
    for (size_t i = cell[first_row]; i < cell[last_row + 1]; ++i) {
      const Place& place = places_[i];
      const bool is_near =
          static_cast<bool>((place.level >= min_level) & (place.level <= max_level) &
                            (std::abs(place.position.x() - center.x()) < radius) &
                            (std::abs(place.position.y() - center.y()) < radius));
      found_[count] = place.keypoint;
      count += is_near ? 1 : 0;
    }
  }
  return {found_.data(), count};
}

FrameFeatures SelectKeypoints(const FrameFeatures& features, std::span<const uint32_t> kept) {
  return {.keypoints = Select(features.keypoints, kept),
          .descriptors = Select(features.descriptors, kept),
          .depth = Select(features.depth, kept),
          .grid = features.grid.Select(kept)};
}

std::vector<uint32_t> KeypointsByDepth(const FrameFeatures& features) {
  std::vector<uint32_t> keypoints;
  for (uint32_t i = 0; i < features.size(); ++i) {
    if (features.depth[i] > 0.0f) {
      keypoints.push_back(i);
    }
  }
  std::stable_sort(keypoints.begin(), keypoints.end(),
                   [&](uint32_t a, uint32_t b) { return features.depth[a] < features.depth[b]; });
  return keypoints;
}

}  // namespace hullslam
