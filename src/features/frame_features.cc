// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/frame_features.h"

#include <algorithm>

namespace hullslam {
namespace {

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
