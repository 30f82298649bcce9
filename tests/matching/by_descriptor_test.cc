// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/by_descriptor.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "matching/made_features.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// The keypoint of `features` that matches a query with `bits`; -1 if there is none.
int FoundByDescriptor(int bits, const FrameFeatures& features,
                      const DescriptorSearch& search = {}) {
  const FrameFeatures query = MakeFeatures({{.bits = bits}});
  const auto matches = MatchByDescriptor(query, All(query), features, search);
  return matches.empty() ? -1 : static_cast<int>(matches[0].keypoint);
}

TEST(MatchByDescriptor, FindsTheMostSimilarKeypointAnywhere) {
  const FrameFeatures features = MakeFeatures({{.pixel = {600.0f, 400.0f}, .bits = 200},
                                               {.pixel = {10.0f, 10.0f}, .bits = 100},
                                               {.pixel = {300.0f, 10.0f}, .bits = 0}});
  EXPECT_EQ(FoundByDescriptor(110, features), 1);
  EXPECT_EQ(FoundByDescriptor(195, features), 0);
}

TEST(MatchByDescriptor, LimitsDistanceAndRatio) {
  const FrameFeatures lone = MakeFeatures({{.bits = 50}});
  EXPECT_EQ(FoundByDescriptor(0, lone), 0);
  EXPECT_EQ(FoundByDescriptor(0, lone, {.max_distance = 49}), -1);
  const FrameFeatures two = MakeFeatures({{.bits = 21}, {.bits = 30}});
  EXPECT_EQ(FoundByDescriptor(0, two), -1);  // 21 is not below 0.7 times 30
  EXPECT_EQ(FoundByDescriptor(1, two), 0);   // 20 is below 0.7 times 29
  const FrameFeatures twins = MakeFeatures({{.bits = 9}, {.bits = 9}});
  EXPECT_EQ(FoundByDescriptor(9, twins, {.max_ratio = 1.0}), -1);
}

TEST(MatchByDescriptor, AKeypointIsMatchedToTheMostSimilarQuery) {
  const FrameFeatures queries = MakeFeatures({{.bits = 10}, {.bits = 4}, {.bits = 4}});
  const FrameFeatures features = MakeFeatures({{.bits = 0}, {.bits = 200}});
  const auto matches = MatchByDescriptor(queries, All(queries), features, {});
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].query, 1u);
  EXPECT_EQ(matches[0].distance, 4);
}

TEST(MatchByDescriptor, ComparesOnlyTheListedQueries) {
  const SyntheticWorld world;
  const FrameFeatures features = world.Observe(0).frame->features;
  const std::vector<uint32_t> some = {3, 17, 90};
  const auto matches = MatchByDescriptor(features, some, features, {});
  ASSERT_EQ(matches.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(matches[i].query, some[i]);
    EXPECT_EQ(matches[i].keypoint, some[i]);
    EXPECT_EQ(matches[i].distance, 0);
  }
}

TEST(MatchByDescriptor, FindsAllAndOnlyTrueMatchesInTwoViews) {
  const SyntheticWorld world({.flipped_bits = 10});
  const SyntheticView a = world.Observe(0);
  const SyntheticView b = world.Observe(40);
  const auto matches =
      MatchByDescriptor(a.frame->features, All(a.frame->features), b.frame->features, {});
  EXPECT_GT(matches.size(), 200u);
  for (const Match& match : matches) {
    EXPECT_EQ(a.points[match.query], b.points[match.keypoint]);
  }
}

TEST(MatchByDescriptor, RotationsMustAgree) {
  std::vector<MadeKeypoint> a;
  std::vector<MadeKeypoint> b;
  for (int i = 0; i < 20; ++i) {
    a.push_back({.bits = 12 * i, .angle = 0.1f * static_cast<float>(i)});
    b.push_back({.bits = 12 * i, .angle = 0.1f * static_cast<float>(i) + (i == 3 ? 2.0f : 0.5f)});
  }
  const FrameFeatures queries = MakeFeatures(a);
  const auto matches = MatchByDescriptor(queries, All(queries), MakeFeatures(b), {});
  ASSERT_EQ(matches.size(), 19u);
  for (const Match& match : matches) {
    EXPECT_NE(match.query, 3u);
  }
}

TEST(MatchByDescriptor, EmptyInputGivesNoMatches) {
  EXPECT_TRUE(MatchByDescriptor(MakeFeatures({}), {}, MakeFeatures({}), {}).empty());
  EXPECT_EQ(FoundByDescriptor(0, MakeFeatures({})), -1);
}

}  // namespace
}  // namespace hullslam
