// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/keypoint_weights.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace hullslam::internal {
namespace {

constexpr float kRadius = 3.0f;  // px

}  // namespace

std::vector<double> KeypointWeights(const Keyframe& keyframe, const ScaleLevels& levels) {
  const FrameFeatures& features = keyframe.frame->features;
  std::vector<double> weights(features.size(), 0.0);
  std::vector<uint32_t> near;
  for (size_t keypoint = 0; keypoint < weights.size(); ++keypoint) {
    if (!keyframe.landmarks[keypoint].IsValid()) {
      continue;
    }
    near.clear();
    features.grid.FindNear(
        features.keypoints,
        features.grid.PositionOf(features.keypoints, static_cast<uint32_t>(keypoint)), kRadius, 0,
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
    weights[keypoint] = sum > 0.0 ? most / sum : 1.0;
  }
  return weights;
}

}  // namespace hullslam::internal
