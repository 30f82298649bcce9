// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "hullslam/features/frame_features.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// A coarse inverse depth image: mean inverse depths (1 over the unit of the map) in cells of 1/16
// of the image's width and 1/12 of its height.
class SeenDepths {
 public:
  // `sensor` must outlive this object. The cells divide the raw image.
  explicit SeenDepths(const Sensor& sensor)
      : sensor_(&sensor), bounds_(sensor.camera.RawBounds()) {}

  // Adds a point at an undistorted pixel. Points that are not in front of the camera are left out.
  void Add(const Eigen::Vector2d& pixel, double depth);
  // The mean of the cell; if the cell is empty, the mean of the whole image; 0 if all cells are
  // empty.
  double InverseDepthAt(const Eigen::Vector2d& pixel) const;
  // One inverse depth per keypoint: from its own depth if that is known, else InverseDepthAt().
  std::vector<double> InverseDepths(const FrameFeatures& features) const;

 private:
  static constexpr int kColumns = 16;
  static constexpr int kRows = 12;
  struct Mean {
    double sum = 0.0;
    int count = 0;
  };

  size_t CellOf(const Eigen::Vector2d& undistorted) const;

  const Sensor* sensor_;
  PinholeCamera::Bounds bounds_;
  std::array<Mean, static_cast<size_t>(kColumns* kRows)> cells_{};
  Mean all_;
};

}  // namespace hullslam
