// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/seen_depths.h"

#include <algorithm>

namespace hullslam {

void SeenDepths::Add(const Eigen::Vector2d& pixel, double depth) {
  if (!(depth > 0.0)) {
    return;
  }
  for (Mean* const mean : {&cells_[CellOf(pixel)], &all_}) {
    mean->sum += 1.0 / depth;
    mean->count += 1;
  }
}

double SeenDepths::InverseDepthAt(const Eigen::Vector2d& pixel) const {
  const Mean& cell = cells_[CellOf(pixel)];
  const Mean& mean = cell.count > 0 ? cell : all_;
  return mean.count > 0 ? mean.sum / mean.count : 0.0;
}

std::vector<double> SeenDepths::InverseDepths(const FrameFeatures& features) const {
  std::vector<double> inverse_depths(features.size());
  for (size_t i = 0; i < features.size(); ++i) {
    const auto depth = static_cast<double>(features.depth[i]);
    inverse_depths[i] = depth > 0.0
                            ? 1.0 / depth
                            : InverseDepthAt(features.keypoints[i].undistorted.cast<double>());
  }
  return inverse_depths;
}

size_t SeenDepths::CellOf(const Eigen::Vector2d& undistorted) const {
  const Eigen::Vector2d pixel = sensor_->camera.Distort(undistorted);
  const double x = (pixel.x() - bounds_.min_x) / (bounds_.max_x - bounds_.min_x);
  const double y = (pixel.y() - bounds_.min_y) / (bounds_.max_y - bounds_.min_y);
  const int column = std::clamp(static_cast<int>(x * kColumns), 0, kColumns - 1);
  const int row = std::clamp(static_cast<int>(y * kRows), 0, kRows - 1);
  return static_cast<size_t>(row * kColumns + column);
}

}  // namespace hullslam
