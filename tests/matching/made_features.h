// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "hullslam/features/feature_grid.h"

namespace hullslam {

// A descriptor with the first `count` bits set. FirstBits(a) and FirstBits(b) have the distance |a
// - b|.
inline Descriptor FirstBits(int count) {
  Descriptor descriptor{};
  for (int i = 0; i < count; ++i) {
    descriptor[static_cast<size_t>(i / 64)] |= uint64_t{1} << (i % 64);
  }
  return descriptor;
}

struct MadeKeypoint {
  Eigen::Vector2f pixel = {0.0f, 0.0f};
  int bits = 0;  // argument of FirstBits()
  int level = 0;
  float depth = 0.0f;  // m
  float angle = 0.0f;
};

// Features of a 640 x 480 image made by hand.
inline FrameFeatures MakeFeatures(const std::vector<MadeKeypoint>& keypoints) {
  FrameFeatures features;
  for (const MadeKeypoint& made : keypoints) {
    Keypoint& keypoint = features.keypoints.emplace_back();
    keypoint.undistorted = made.pixel;
    keypoint.level = made.level;
    keypoint.angle = made.angle;
    features.descriptors.push_back(FirstBits(made.bits));
    features.depth.push_back(made.depth);
  }
  features.grid = FeatureGrid(features.keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  return features;
}

// The indices of all keypoints.
inline std::vector<uint32_t> All(const FrameFeatures& features) {
  std::vector<uint32_t> indices(features.size());
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

}  // namespace hullslam
