// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/frame_features.h"

#include <gtest/gtest.h>

#include <utility>

namespace hullslam {
namespace {

TEST(FrameFeatures, CountsItsKeypoints) {
  FrameFeatures features;
  EXPECT_EQ(features.size(), 0u);
  features.keypoints.resize(3);
  EXPECT_EQ(features.size(), 3u);
}

// The grid holds numbers of keypoints, no addresses, so it stays good when the whole is moved.
TEST(FrameFeatures, GridIsGoodAfterAMove) {
  FrameFeatures features;
  features.keypoints.resize(2);
  features.keypoints[0].undistorted = {10.0f, 10.0f};
  features.keypoints[1].undistorted = {500.0f, 300.0f};
  features.grid = FeatureGrid(features.keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  const FrameFeatures moved = std::move(features);
  std::vector<uint32_t> found;
  moved.grid.FindNear(moved.keypoints, {501.0f, 299.0f}, 5.0f, 0, 7, found);
  EXPECT_EQ(found, std::vector<uint32_t>{1});
}

}  // namespace
}  // namespace hullslam
