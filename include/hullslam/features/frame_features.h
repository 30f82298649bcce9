// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/features/feature_grid.h"
#include "hullslam/features/feature_set.h"

namespace hullslam {

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
