// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/features/feature_set.h"

namespace hullslam {

// Keypoints sorted into cells of the image, to find the keypoints near a pixel. Every keyframe
// keeps a grid, so a grid is small: two bytes per keypoint and two per cell.
class FeatureGrid {
 public:
  FeatureGrid() = default;
  // Sorts by `undistorted`. The box is the undistorted image, in px. Keypoints outside it
  // are put into the nearest cell. Throws CheckError if the box is empty, or if there are more than
  // 65535 keypoints.
  FeatureGrid(std::span<const Keypoint> keypoints, const Eigen::Vector2f& box_min,
              const Eigen::Vector2f& box_max);
  // Sorts by these positions, one per keypoint, in the box from 0 to `box_max`. GridSearch compares
  // them too.
  FeatureGrid(std::span<const Keypoint> keypoints, std::vector<Eigen::Vector2f> positions,
              const Eigen::Vector2f& box_max);

  // The grid of the keypoints with these indices, which increase. Their new indices are their
  // indices in `kept`. A grid without keypoints stays as it is.
  FeatureGrid Select(std::span<const uint32_t> kept) const;

  // The position by which a keypoint is sorted.
  Eigen::Vector2f PositionOf(std::span<const Keypoint> keypoints, uint32_t keypoint) const {
    return positions_.empty() ? keypoints[keypoint].undistorted : positions_[keypoint];
  }

 private:
  friend class GridSearch;
  void Sort(std::span<const Keypoint> keypoints, const Eigen::Vector2f& box_max);
  int Column(float x) const;
  int Row(float y) const;

  // With cells of half this size, a search visits half as many keypoints but more cells, and takes
  // as long; the table of cells would be four times as large.
  static constexpr int kColumns = 32;
  static constexpr int kRows = 24;
  Eigen::Vector2f min_ = Eigen::Vector2f::Zero();
  Eigen::Vector2f cells_per_pixel_ = Eigen::Vector2f::Zero();
  std::vector<uint16_t> cell_start_;        // kColumns kRows + 1, into order_; column-major
  std::vector<uint16_t> order_;             // keypoint indices, cell by cell
  std::vector<Eigen::Vector2f> positions_;  // empty: as in the keypoints
};

// Searches of keypoints in one image. Keeps what it compares in the order of the cells.
class GridSearch {
 public:
  // The grid must outlive this object, and it must be that of the keypoints.
  GridSearch(const FeatureGrid& grid, std::span<const Keypoint> keypoints);
  // The indices of all keypoints with |dx| < radius, |dy| < radius and a level from min_level to
  // max_level. Cells are visited one after the other; within a cell the indices are in increasing
  // order. They are valid until the next call.
  std::span<const uint32_t> FindNear(const Eigen::Vector2f& center, float radius, int min_level,
                                     int max_level);

 private:
  struct Place {
    Eigen::Vector2f position;
    int level;
    uint32_t keypoint;
  };
  const FeatureGrid& grid_;
  std::vector<Place> places_;
  std::vector<uint32_t> found_;  // one more than there are keypoints
};

// Everything that matching needs to know about one image. The vectors have one entry per keypoint.
struct FrameFeatures {
  std::vector<Keypoint> keypoints;
  std::vector<Descriptor> descriptors;
  std::vector<float> depth;  // m along the optical axis, 0 where unknown
  FeatureGrid grid;

  size_t size() const { return keypoints.size(); }
};

// The features of the keypoints with these indices, which increase. Their new indices are their
// indices in `kept`.
FrameFeatures SelectKeypoints(const FrameFeatures& features, std::span<const uint32_t> kept);

// The indices of the keypoints whose depth is known, nearest first; equal depths by index.
std::vector<uint32_t> KeypointsByDepth(const FrameFeatures& features);

}  // namespace hullslam
