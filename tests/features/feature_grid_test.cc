// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/feature_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "features/find_near.h"
#include "hullslam/util/check.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// Keypoints in the undistorted image of a camera like TUM1, some of them outside the box.
std::vector<Keypoint> MakeKeypoints(size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> x(-40.0f, 680.0f);
  std::uniform_real_distribution<float> y(-40.0f, 520.0f);
  std::vector<Keypoint> keypoints(count);
  for (Keypoint& keypoint : keypoints) {
    keypoint.undistorted = {x(random), y(random)};
    keypoint.level = static_cast<int>(random() % 8);
  }
  return keypoints;
}

FeatureGrid MakeGrid(const std::vector<Keypoint>& keypoints) {
  return FeatureGrid(keypoints, {-20.5f, -18.0f}, {655.0f, 500.0f});
}

std::vector<uint32_t> FindBySearchingAll(const std::vector<Keypoint>& keypoints,
                                         const Eigen::Vector2f& center, float radius, int min_level,
                                         int max_level) {
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < keypoints.size(); ++i) {
    const Keypoint& keypoint = keypoints[i];
    const Eigen::Vector2f offset = keypoint.undistorted - center;
    if (std::abs(offset.x()) < radius && std::abs(offset.y()) < radius &&
        keypoint.level >= min_level && keypoint.level <= max_level) {
      found.push_back(i);
    }
  }
  return found;
}

TEST(FeatureGrid, FindsTheSameAsASearchOfAllKeypoints) {
  const std::vector<Keypoint> keypoints = MakeKeypoints(1000);
  const FeatureGrid grid = MakeGrid(keypoints);
  size_t total = 0;
  for (const float radius : {0.5f, 7.0f, 40.0f, 1000.0f}) {
    for (float y = -60.0f; y < 540.0f; y += 37.0f) {
      for (float x = -60.0f; x < 700.0f; x += 41.0f) {
        std::vector<uint32_t> found;
        FindNear(grid, keypoints, {x, y}, radius, 2, 5, found);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, FindBySearchingAll(keypoints, {x, y}, radius, 2, 5));
        total += found.size();
      }
    }
  }
  EXPECT_GT(total, 10000u);
}

TEST(FeatureGrid, FindsEveryKeypointAtItsPosition) {
  const std::vector<Keypoint> keypoints = MakeKeypoints(500);
  const FeatureGrid grid = MakeGrid(keypoints);
  for (uint32_t i = 0; i < keypoints.size(); ++i) {
    const Keypoint& keypoint = keypoints[i];
    std::vector<uint32_t> found;
    FindNear(grid, keypoints, keypoint.undistorted, 0.01f, keypoint.level, keypoint.level, found);
    EXPECT_NE(std::find(found.begin(), found.end(), i), found.end());
  }
}

TEST(FeatureGrid, AppendsInOrderOfIndexWithinACell) {
  std::vector<Keypoint> keypoints(4);
  for (Keypoint& keypoint : keypoints) {
    keypoint.undistorted = {100.0f, 100.0f};
  }
  keypoints[1].undistorted = {300.0f, 300.0f};
  const FeatureGrid grid(keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  std::vector<uint32_t> found = {77};
  FindNear(grid, keypoints, {100.0f, 100.0f}, 5.0f, 0, 7, found);
  EXPECT_EQ(found, (std::vector<uint32_t>{77, 0, 2, 3}));
}

TEST(FeatureGrid, SearchesInTheGivenPositions) {
  std::vector<Keypoint> keypoints(3);
  for (Keypoint& keypoint : keypoints) {
    keypoint.undistorted = {5000.0f, -3000.0f};
  }
  const std::vector<Eigen::Vector2f> positions = {{10.0f, 20.0f}, {300.0f, 200.0f}, {12.0f, 21.0f}};
  const Eigen::Vector2f box(640.0f, 480.0f);
  const FeatureGrid grid(keypoints, positions, box);
  std::vector<uint32_t> found;
  FindNear(grid, keypoints, {11.0f, 20.0f}, 5.0f, 0, 7, found);
  EXPECT_EQ(found, (std::vector<uint32_t>{0, 2}));
  const std::vector<uint32_t> kept = {1, 2};
  const std::vector<Keypoint> rest(keypoints.begin() + 1, keypoints.end());
  found.clear();
  FindNear(grid.Select(kept), rest, {300.0f, 200.0f}, 5.0f, 0, 7, found);
  EXPECT_EQ(found, (std::vector<uint32_t>{0}));
  EXPECT_EQ(grid.PositionOf(keypoints, 1), positions[1]);
  EXPECT_THROW(FeatureGrid(rest, positions, box), CheckError);
}

TEST(FeatureGrid, RadiusIsExclusive) {
  std::vector<Keypoint> keypoints(1);
  keypoints[0].undistorted = {100.0f, 100.0f};
  const FeatureGrid grid(keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  std::vector<uint32_t> found;
  FindNear(grid, keypoints, {105.0f, 100.0f}, 5.0f, 0, 7, found);
  FindNear(grid, keypoints, {100.0f, 95.0f}, 5.0f, 0, 7, found);
  EXPECT_TRUE(found.empty());
  FindNear(grid, keypoints, {104.99f, 95.01f}, 5.0f, 0, 7, found);
  EXPECT_EQ(found.size(), 1u);
}

TEST(FeatureGrid, FindsNothingWithoutKeypoints) {
  std::vector<uint32_t> found;
  FindNear(FeatureGrid(), {}, {1.0f, 1.0f}, 100.0f, 0, 7, found);
  FindNear(FeatureGrid({}, {0.0f, 0.0f}, {640.0f, 480.0f}), {}, {1.0f, 1.0f}, 9.0f, 0, 7, found);
  EXPECT_TRUE(found.empty());
}

// A point just in front of the camera can be projected to any pixel.
TEST(FeatureGrid, AcceptsCentersThatAreFarAwayOrNotFinite) {
  const std::vector<Keypoint> keypoints = MakeKeypoints(100);
  const FeatureGrid grid = MakeGrid(keypoints);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::vector<uint32_t> found;
  for (const float far : {1e30f, -1e30f, kInfinity, -kInfinity, kNan}) {
    FindNear(grid, keypoints, {far, 100.0f}, 20.0f, 0, 7, found);
    FindNear(grid, keypoints, {100.0f, far}, 20.0f, 0, 7, found);
  }
  EXPECT_TRUE(found.empty());
}

TEST(FeatureGrid, RejectsMoreKeypointsThanAnIndexOf16BitsCanCount) {
  std::vector<Keypoint> keypoints = MakeKeypoints(65535);
  std::vector<uint32_t> found;
  FindNear(MakeGrid(keypoints), keypoints, keypoints.back().undistorted, 0.5f, 0, 7, found);
  EXPECT_EQ(std::count(found.begin(), found.end(), 65534u), 1);
  keypoints.emplace_back();
  EXPECT_THROW(MakeGrid(keypoints), CheckError);
}

TEST(FeatureGrid, OfAPartOfTheKeypointsEqualsANewGrid) {
  const std::vector<Keypoint> keypoints = MakeKeypoints(1000);
  std::vector<uint32_t> kept;
  std::vector<Keypoint> part;
  for (uint32_t i = 0; i < keypoints.size(); i += 1 + i % 4) {
    kept.push_back(i);
    part.push_back(keypoints[i]);
  }
  const FeatureGrid selected = MakeGrid(keypoints).Select(kept);
  const FeatureGrid made = MakeGrid(part);
  for (float y = -60.0f; y < 540.0f; y += 37.0f) {
    for (float x = -60.0f; x < 700.0f; x += 41.0f) {
      std::vector<uint32_t> found;
      std::vector<uint32_t> expected;
      FindNear(selected, part, {x, y}, 60.0f, 0, 7, found);
      FindNear(made, part, {x, y}, 60.0f, 0, 7, expected);
      EXPECT_EQ(found, expected);
    }
  }
  std::vector<uint32_t> found;
  FindNear(MakeGrid(keypoints).Select({}), {}, {300.0f, 200.0f}, 1000.0f, 0, 7, found);
  FindNear(FeatureGrid().Select({}), {}, {300.0f, 200.0f}, 1000.0f, 0, 7, found);
  EXPECT_TRUE(found.empty());
}

TEST(FeatureGrid, RejectsAnEmptyBox) {
  EXPECT_THROW(FeatureGrid({}, {0.0f, 0.0f}, {0.0f, 480.0f}), CheckError);
}

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
  FindNear(moved.grid, moved.keypoints, {501.0f, 299.0f}, 5.0f, 0, 7, found);
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
