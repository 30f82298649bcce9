// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/by_descriptor.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "hullslam/util/check.h"
#include "matching/made_features.h"
#include "support/made_vocabulary.h"
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

std::vector<VocabularyNodeId> Nodes(const std::vector<int>& numbers) {
  std::vector<VocabularyNodeId> nodes;
  for (const int number : numbers) {
    nodes.push_back(number < 0 ? VocabularyNodeId()
                               : VocabularyNodeId(static_cast<uint32_t>(number)));
  }
  return nodes;
}

// The keypoint that matches a query with `bits` under node 5; -1 if there is none.
int FoundByWords(int bits, const std::vector<MadeKeypoint>& keypoints,
                 const std::vector<int>& nodes, const WordSearch& search = {}) {
  const auto matches = MatchByWords(MakeFeatures({{.bits = bits}}), Nodes({5}),
                                    MakeFeatures(keypoints), Nodes(nodes), search);
  return matches.empty() ? -1 : static_cast<int>(matches[0].keypoint);
}

TEST(MatchByWords, ComparesKeypointsOfTheSameNodeOnly) {
  const std::vector<MadeKeypoint> keypoints = {{.bits = 100}, {.bits = 110}, {.bits = 160}};
  EXPECT_EQ(FoundByWords(100, keypoints, {5, 5, 5}, {.max_ratio = 1.0}), 0);
  EXPECT_EQ(FoundByWords(100, keypoints, {4, 5, 5}), 1);
  EXPECT_EQ(FoundByWords(100, keypoints, {4, 6, 5}, {.max_distance = 60}), 2);
  EXPECT_EQ(FoundByWords(100, keypoints, {4, 6, 7}), -1);
  EXPECT_EQ(FoundByWords(100, keypoints, {-1, 5, -1}), 1);
}

TEST(MatchByWords, KeypointsWithoutANodeAreNotMatched) {
  const FrameFeatures one = MakeFeatures({{.bits = 3}});
  EXPECT_TRUE(MatchByWords(one, Nodes({-1}), one, Nodes({-1}), {}).empty());
}

// The second best distance is that under the same node.
TEST(MatchByWords, LimitsDistanceAndRatio) {
  EXPECT_EQ(FoundByWords(0, {{.bits = 50}}, {5}), 0);
  EXPECT_EQ(FoundByWords(0, {{.bits = 51}}, {5}), -1);
  EXPECT_EQ(FoundByWords(0, {{.bits = 21}, {.bits = 30}}, {5, 5}), -1);  // not below 0.7 times 30
  EXPECT_EQ(FoundByWords(1, {{.bits = 21}, {.bits = 30}}, {5, 5}), 0);
  EXPECT_EQ(FoundByWords(0, {{.bits = 21}, {.bits = 30}}, {5, 4}), 0);
  EXPECT_EQ(FoundByWords(9, {{.bits = 9}, {.bits = 9}}, {5, 5}, {.max_ratio = 1.0}), 0);
}

TEST(MatchByWords, AKeypointIsMatchedToTheMostSimilarQuery) {
  const FrameFeatures queries = MakeFeatures({{.bits = 10}, {.bits = 4}, {.bits = 4}});
  const auto matches =
      MatchByWords(queries, Nodes({2, 2, 2}), MakeFeatures({{.bits = 0}}), Nodes({2}), {});
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].query, 1u);
  EXPECT_EQ(matches[0].distance, 4);
}

TEST(MatchByWords, ExcludedPairsAreNotCompared) {
  const std::vector<MadeKeypoint> keypoints = {{.bits = 10}, {.bits = 20}};
  EXPECT_EQ(FoundByWords(10, keypoints, {5, 5}), 0);
  EXPECT_EQ(FoundByWords(10, keypoints, {5, 5},
                         {.may_match = [](uint32_t, uint32_t keypoint) { return keypoint == 1; }}),
            1);
  EXPECT_EQ(
      FoundByWords(10, keypoints, {5, 5}, {.may_match = [](uint32_t, uint32_t) { return false; }}),
      -1);
}

TEST(MatchByWords, RotationsMustAgreeIfTheyAreCompared) {
  std::vector<MadeKeypoint> a;
  std::vector<MadeKeypoint> b;
  std::vector<int> nodes;
  for (int i = 0; i < 20; ++i) {
    a.push_back({.bits = 12 * i, .angle = 0.1f * static_cast<float>(i)});
    b.push_back({.bits = 12 * i, .angle = 0.1f * static_cast<float>(i) + (i == 3 ? 2.0f : 0.5f)});
    nodes.push_back(19 - i);
  }
  const auto count = [&](bool compare) {
    return MatchByWords(MakeFeatures(a), Nodes(nodes), MakeFeatures(b), Nodes(nodes),
                        {.compare_rotation = compare})
        .size();
  };
  EXPECT_EQ(count(true), 19u);
  EXPECT_EQ(count(false), 20u);
}

// Under the root all keypoints are compared; further down only some of the matches are found.
TEST(MatchByWords, FindsOnlyTrueMatchesInTwoViews) {
  const Vocabulary vocabulary = MadeVocabulary(6, 3);
  const SyntheticWorld world({.flipped_bits = 10});
  const SyntheticView a = world.Observe(0);
  const SyntheticView b = world.Observe(40);
  const auto words_a = vocabulary.WordsOf(a.frame->features.descriptors);
  const auto words_b = vocabulary.WordsOf(b.frame->features.descriptors);
  size_t fewest = 1'000'000;
  for (const int level : {0, 1, 2, 3}) {
    const auto matches = MatchByWords(a.frame->features, vocabulary.NodesOf(words_a, level),
                                      b.frame->features, vocabulary.NodesOf(words_b, level), {});
    EXPECT_GT(matches.size(), 30u);
    EXPECT_LE(matches.size(), fewest);
    fewest = matches.size();
    for (const Match& match : matches) {
      EXPECT_EQ(a.points[match.query], b.points[match.keypoint]);
      EXPECT_EQ(vocabulary.NodeOf(words_a[match.query], level),
                vocabulary.NodeOf(words_b[match.keypoint], level));
    }
  }
}

TEST(MatchByWords, NeedsOneNodePerKeypoint) {
  const FrameFeatures one = MakeFeatures({{.bits = 3}});
  EXPECT_THROW(MatchByWords(one, Nodes({1, 2}), one, Nodes({1}), {}), CheckError);
  EXPECT_THROW(MatchByWords(one, Nodes({1}), one, {}, {}), CheckError);
  EXPECT_TRUE(MatchByWords(MakeFeatures({}), {}, MakeFeatures({}), {}, {}).empty());
}

}  // namespace
}  // namespace hullslam
