// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/frame_features.h"

#include <algorithm>

namespace hullslam {

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
