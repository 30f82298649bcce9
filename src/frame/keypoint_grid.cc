// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/keypoint_grid.h"

#include <utility>
#include <vector>

namespace hullslam {

FeatureGrid MakeKeypointGrid(std::span<const Keypoint> keypoints, const PinholeCamera& camera) {
  const Eigen::Vector2f size = Eigen::Vector2i(camera.width, camera.height).cast<float>();
  if (!camera.IsDistorted()) {
    return {keypoints, Eigen::Vector2f::Zero(), size};
  }
  std::vector<Eigen::Vector2f> positions;
  positions.reserve(keypoints.size());
  for (const Keypoint& keypoint : keypoints) {
    positions.emplace_back(camera.Distort(keypoint.undistorted.cast<double>()).cast<float>());
  }
  return {keypoints, std::move(positions), size};
}

}  // namespace hullslam
