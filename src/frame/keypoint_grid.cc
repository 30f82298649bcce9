// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/keypoint_grid.h"

#include <utility>
#include <vector>

namespace hullslam {

FeatureGrid MakeKeypointGrid(std::span<const Keypoint> keypoints, const PinholeCamera& camera,
                             const PinholeCamera::Bounds& bounds) {
  if (!camera.IsFisheye()) {
    return {keypoints, Eigen::Vector2d(bounds.min_x, bounds.min_y).cast<float>(),
            Eigen::Vector2d(bounds.max_x, bounds.max_y).cast<float>()};
  }
  std::vector<Eigen::Vector2f> positions;
  positions.reserve(keypoints.size());
  for (const Keypoint& keypoint : keypoints) {
    positions.emplace_back(camera.Distort(keypoint.undistorted.cast<double>()).cast<float>());
  }
  return {keypoints, std::move(positions),
          Eigen::Vector2i(camera.width, camera.height).cast<float>()};
}

}  // namespace hullslam
