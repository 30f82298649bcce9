// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/by_projection.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "hullslam/util/check.h"
#include "matching/made_features.h"
#include "support/synthetic_world.h"
#include "support/test_cameras.h"

namespace hullslam {
namespace {

Projection At(float x, float y) {
  Projection projection;
  projection.pixel = {x, y};
  projection.radius = 10.0f;
  projection.max_level = 7;
  return projection;
}

// The keypoint found for one projection; -1 if there is none.
int FoundNear(const FrameFeatures& features, const Projection& projection,
              const ProjectionSearch& search = {}, const std::vector<uint8_t>& taken = {}) {
  const std::vector<Match> matches = MatchByProjection(features, {&projection, 1}, taken, search);
  EXPECT_LE(matches.size(), 1u);
  return matches.empty() ? -1 : static_cast<int>(matches[0].keypoint);
}

TEST(MatchByProjection, TakesTheMostSimilarDescriptorInTheWindow) {
  const FrameFeatures features = MakeFeatures({{.pixel = {100.0f, 100.0f}, .bits = 30},
                                               {.pixel = {109.0f, 91.0f}, .bits = 20},
                                               {.pixel = {111.0f, 100.0f}, .bits = 0},
                                               {.pixel = {100.0f, 111.0f}, .bits = 0}});
  const Projection projection = At(100.0f, 100.0f);
  const auto matches = MatchByProjection(features, {&projection, 1}, {}, {});
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].query, 0u);
  EXPECT_EQ(matches[0].keypoint, 1u);
  EXPECT_EQ(matches[0].distance, 20);
}

TEST(MatchByProjection, TakesTheMostSimilarOfTheKeypointsThatMayMatch) {
  const FrameFeatures features = MakeFeatures({{.pixel = {100.0f, 100.0f}, .bits = 0},
                                               {.pixel = {101.0f, 100.0f}, .bits = 20},
                                               {.pixel = {102.0f, 100.0f}, .bits = 10}});
  const std::vector<Projection> projections = {At(100.0f, 100.0f), At(100.0f, 100.0f)};
  // The second projection may match nothing, the first all but the most similar keypoint.
  const auto may_match = [](uint32_t query, uint32_t keypoint) {
    return query == 0 && keypoint != 0;
  };
  const auto matches = MatchByProjection(features, projections, {}, {.may_match = may_match});
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].query, 0u);
  EXPECT_EQ(matches[0].keypoint, 2u);
}

TEST(MatchByProjection, SearchesOnlyTheGivenLevels) {
  const FrameFeatures features = MakeFeatures({{.pixel = {100.0f, 100.0f}, .bits = 0, .level = 1},
                                               {.pixel = {100.0f, 100.0f}, .bits = 5, .level = 2},
                                               {.pixel = {100.0f, 100.0f}, .bits = 9, .level = 3},
                                               {.pixel = {100.0f, 100.0f}, .bits = 0, .level = 4}});
  Projection projection = At(100.0f, 100.0f);
  projection.min_level = 2;
  projection.max_level = 3;
  EXPECT_EQ(FoundNear(features, projection), 1);
  projection.min_level = 5;
  projection.max_level = 7;
  EXPECT_EQ(FoundNear(features, projection), -1);
}

TEST(MatchByProjection, TheLimitOfTheDistanceIsInclusive) {
  const FrameFeatures features = MakeFeatures({{.pixel = {100.0f, 100.0f}, .bits = 60}});
  EXPECT_EQ(FoundNear(features, At(100.0f, 100.0f), {.max_distance = 60}), 0);
  EXPECT_EQ(FoundNear(features, At(100.0f, 100.0f), {.max_distance = 59}), -1);
}

TEST(MatchByProjection, RatioComparesOnlyKeypointsOfTheSameLevel) {
  const std::vector<MadeKeypoint> same_level = {{.pixel = {100.0f, 100.0f}, .bits = 40},
                                                {.pixel = {101.0f, 100.0f}, .bits = 45}};
  const Projection projection = At(100.0f, 100.0f);
  EXPECT_EQ(FoundNear(MakeFeatures(same_level), projection, {.max_ratio = 0.8}), -1);
  EXPECT_EQ(FoundNear(MakeFeatures(same_level), projection, {.max_ratio = 0.9}), 0);
  EXPECT_EQ(FoundNear(MakeFeatures(same_level), projection, {.max_ratio = 1.0}), 0);

  std::vector<MadeKeypoint> two_levels = same_level;
  two_levels[1].level = 1;  // the same corner, one level up
  EXPECT_EQ(FoundNear(MakeFeatures(two_levels), projection, {.max_ratio = 0.8}), 0);
}

TEST(MatchByProjection, RatioRejectsTwinsAndAcceptsASingleCandidate) {
  const FrameFeatures twins = MakeFeatures(
      {{.pixel = {100.0f, 100.0f}, .bits = 40}, {.pixel = {101.0f, 100.0f}, .bits = 40}});
  EXPECT_EQ(FoundNear(twins, At(100.0f, 100.0f), {.max_ratio = 0.9}), -1);
  EXPECT_EQ(FoundNear(twins, At(100.0f, 100.0f)), 0);  // without the test the lower index wins
  const FrameFeatures lone = MakeFeatures({{.pixel = {100.0f, 100.0f}, .bits = 40}});
  EXPECT_EQ(FoundNear(lone, At(100.0f, 100.0f), {.max_ratio = 0.1}), 0);
}

TEST(MatchByProjection, LeavesOutTakenKeypoints) {
  const FrameFeatures features = MakeFeatures(
      {{.pixel = {100.0f, 100.0f}, .bits = 0}, {.pixel = {101.0f, 100.0f}, .bits = 9}});
  EXPECT_EQ(FoundNear(features, At(100.0f, 100.0f), {}, {1, 0}), 1);
  EXPECT_EQ(FoundNear(features, At(100.0f, 100.0f), {}, {1, 1}), -1);
  // A taken keypoint does not count as the second best either.
  EXPECT_EQ(FoundNear(features, At(100.0f, 100.0f), {.max_ratio = 0.1}, {1, 0}), 1);
  const Projection projection = At(100.0f, 100.0f);
  const std::vector<uint8_t> too_short = {0};
  EXPECT_THROW(MatchByProjection(features, {&projection, 1}, too_short, {}), CheckError);
}

TEST(MatchByProjection, TheDepthIsComparedIfBothAreKnown) {
  const FrameFeatures features =
      MakeFeatures({{.pixel = {100.0f, 100.0f}, .bits = 0, .depth = 1.0f},
                    {.pixel = {101.0f, 100.0f}, .bits = 5, .depth = 2.0f},
                    {.pixel = {102.0f, 100.0f}, .bits = 9}});
  Projection projection = At(100.0f, 100.0f);
  EXPECT_EQ(FoundNear(features, projection), 0);  // the projection has no depth
  const auto expect_disparity = [&](double disparity) {
    projection.ExpectDepth(40.0 / disparity, 40.0);
  };
  expect_disparity(20.0 - projection.radius + 0.1);
  EXPECT_EQ(FoundNear(features, projection), 1);
  expect_disparity(40.0 - projection.radius + 0.1);
  EXPECT_EQ(FoundNear(features, projection), 0);
  expect_disparity(40.0 + projection.radius + 0.1);
  EXPECT_EQ(FoundNear(features, projection), 2);  // the keypoint without depth cannot disagree
}

TEST(MatchByProjection, AKeypointIsMatchedToTheMostSimilarProjection) {
  const FrameFeatures features = MakeFeatures({{.pixel = {100.0f, 100.0f}, .bits = 50}});
  std::vector<Projection> projections(3, At(100.0f, 100.0f));
  projections[0].descriptor = FirstBits(20);
  projections[1].descriptor = FirstBits(45);
  projections[2].descriptor = FirstBits(55);
  const auto matches = MatchByProjection(features, projections, {}, {});
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].query, 1u);  // ties with query 2 and comes first
}

TEST(MatchByProjection, RotationIsComparedOnlyOnRequest) {
  std::vector<MadeKeypoint> made;
  std::vector<Projection> projections;
  for (int i = 0; i < 20; ++i) {
    const auto x = static_cast<float>(20 + 30 * i);
    made.push_back({.pixel = {x, 100.0f}, .angle = i == 7 ? 3.0f : 1.0f});
    projections.push_back(At(x, 100.0f));
    projections.back().angle = 1.2f;
  }
  const FrameFeatures features = MakeFeatures(made);
  EXPECT_EQ(MatchByProjection(features, projections, {}, {}).size(), 20u);
  const auto matches = MatchByProjection(features, projections, {}, {.compare_rotation = true});
  ASSERT_EQ(matches.size(), 19u);
  for (const Match& match : matches) {
    EXPECT_NE(match.keypoint, 7u);
  }
}

class MatchByProjectionWith : public testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(MatchByProjectionWith);

TEST_P(MatchByProjectionWith, FindsEveryPointOfTheWorldAtItsProjection) {
  const SyntheticWorld world({.pixel_noise = 0.5, .flipped_bits = 10}, GetParam().sensor);
  const Sensor& sensor = world.sensor();
  const SyntheticView view = world.Observe(10);
  const FrameFeatures& features = view.frame->features;
  std::vector<Projection> projections;
  for (uint32_t point = 0; point < world.points().size(); ++point) {
    const Eigen::Vector3d in_cam = SyntheticWorld::CamFromWorld(10) * world.points()[point];
    Projection projection = At(0.0f, 0.0f);
    const Eigen::Vector2d pixel = sensor.camera.Project(in_cam);
    projection.pixel = sensor.camera.Distort(pixel).cast<float>();
    projection.descriptor = world.descriptor(point);
    projection.radius = 15.0f;
    projection.ExpectDepth(in_cam.z(), sensor.camera.bf);
    projections.push_back(projection);
  }
  const auto matches = MatchByProjection(features, projections, {}, {.max_distance = 50});
  EXPECT_GT(matches.size(), view.points.size() * 99 / 100);
  for (const Match& match : matches) {
    EXPECT_EQ(view.points[match.keypoint], match.query);
  }
}

TEST(MatchByProjection, EmptyInputGivesNoMatches) {
  EXPECT_TRUE(MatchByProjection(MakeFeatures({}), {}, {}, {}).empty());
  EXPECT_EQ(FoundNear(MakeFeatures({}), At(100.0f, 100.0f)), -1);
}

}  // namespace
}  // namespace hullslam
