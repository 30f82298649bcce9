// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/frame_features.h"

#include <gtest/gtest.h>

#include <utility>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

TEST(FrameFeatures, CountsItsKeypoints) {
  FrameFeatures features;
  EXPECT_EQ(features.size(), 0u);
  features.keypoints.resize(3);
  EXPECT_EQ(features.size(), 3u);
}

// The grid stores indices of keypoints and no addresses, so it stays valid when the features are
// moved.
TEST(FrameFeatures, GridIsValidAfterAMove) {
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

// Checks the synthetic frames that other tests use.
TEST(FrameFeatures, SyntheticFeaturesAreProjectionsOfTheWorldPoints) {
  const SyntheticWorld world({.depth_share = 0.5});
  for (const uint32_t index : {0u, 30u, 130u}) {
    const SyntheticView view = world.Observe(index);
    const FrameFeatures& features = view.frame->features;
    ASSERT_EQ(features.size(), view.points.size());
    ASSERT_GT(features.size(), 200u);
    int with_depth = 0;
    for (size_t i = 0; i < features.size(); ++i) {
      const Eigen::Vector3d point =
          SyntheticWorld::CamFromWorld(index) * world.points()[view.points[i]];
      const Eigen::Vector2d pixel = world.sensor().camera.Project(point);
      EXPECT_LT((features.keypoints[i].undistorted.cast<double>() - pixel).norm(), 1e-4);
      EXPECT_EQ(features.descriptors[i], world.descriptor(view.points[i]));
      if (features.depth[i] > 0.0f) {
        ++with_depth;
        EXPECT_NEAR(features.depth[i], point.z(), 1e-5);
      }
    }
    EXPECT_NEAR(with_depth, 0.5 * static_cast<double>(features.size()),
                0.1 * static_cast<double>(features.size()));
  }
}

TEST(FrameFeatures, SyntheticFeaturesAreReproducible) {
  const SyntheticWorldOptions options{.pixel_noise = 1.0, .flipped_bits = 5, .seed = 3};
  const SyntheticView first = SyntheticWorld(options).Observe(7);
  const SyntheticView second = SyntheticWorld(options).Observe(7);
  ASSERT_EQ(first.points, second.points);
  EXPECT_EQ(first.frame->features.descriptors, second.frame->features.descriptors);
}

TEST(KeypointsByDepth, AreThoseWithDepthNearestFirst) {
  FrameFeatures features;
  features.keypoints.resize(5);
  features.depth = {2.0f, 0.0f, 1.0f, 2.0f, 0.5f};
  EXPECT_EQ(KeypointsByDepth(features), (std::vector<uint32_t>{4, 2, 0, 3}));
  EXPECT_TRUE(KeypointsByDepth({}).empty());
}

}  // namespace
}  // namespace hullslam
