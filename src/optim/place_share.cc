// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/place_share.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace hullslam::internal {
namespace {

constexpr float kRadius = 3.0f;  // px

}  // namespace

double ShareOfPlace(const Keyframe& keyframe, uint32_t keypoint, const ScaleLevels& levels) {
  const FrameFeatures& features = keyframe.frame->features;
  std::vector<uint32_t> near;
  features.grid.FindNear(features.keypoints, features.keypoints[keypoint].undistorted, kRadius, 0,
                         std::numeric_limits<int>::max(), near);
  double most = 0.0;
  double sum = 0.0;
  for (const uint32_t i : near) {
    if (keyframe.landmarks[i].IsValid()) {
      const auto level = static_cast<size_t>(features.keypoints[i].level);
      const auto information = static_cast<double>(levels.inverse_sigma2[level]);
      most = std::max(most, information);
      sum += information;
    }
  }
  return sum > 0.0 ? most / sum : 1.0;
}

}  // namespace hullslam::internal
