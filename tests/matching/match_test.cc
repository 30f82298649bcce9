// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace hullslam {
namespace {

constexpr float kDegree = static_cast<float>(std::numbers::pi / 180.0);

std::vector<uint32_t> Queries(const std::vector<Match>& matches) {
  std::vector<uint32_t> queries;
  for (const Match& match : matches) {
    queries.push_back(match.query);
  }
  return queries;
}

// Returns the queries that KeepConsistentRotations() keeps. Match i pairs query i with keypoint i,
// whose angle is smaller by changes[i] degrees.
std::vector<uint32_t> KeptOf(const std::vector<float>& changes, float turn = 0.0f) {
  std::vector<Match> matches;
  std::vector<float> query_angles;
  std::vector<float> keypoint_angles;
  for (uint32_t i = 0; i < changes.size(); ++i) {
    matches.push_back({i, i, 0});
    keypoint_angles.push_back(static_cast<float>(i) * 0.1f);
    query_angles.push_back(keypoint_angles.back() + (changes[i] + turn) * kDegree);
  }
  KeepConsistentRotations(query_angles, keypoint_angles, matches);
  return Queries(matches);
}

std::vector<float> Repeated(const std::vector<std::pair<float, int>>& groups) {
  std::vector<float> values;
  for (const auto& [value, count] : groups) {
    values.insert(values.end(), static_cast<size_t>(count), value);
  }
  return values;
}

std::vector<uint32_t> Range(uint32_t begin, uint32_t end) {
  std::vector<uint32_t> range(end - begin);
  std::iota(range.begin(), range.end(), begin);
  return range;
}

TEST(KeepBestPerKeypoint, KeepsTheLeastDistanceAndTiesGoToTheLowestQuery) {
  std::vector<Match> matches = {{5, 1, 20}, {0, 1, 30}, {3, 2, 7}, {2, 2, 7}, {4, 9, 99}};
  KeepBestPerKeypoint(matches);
  ASSERT_EQ(Queries(matches), (std::vector<uint32_t>{2, 4, 5}));
  EXPECT_EQ(matches[0].keypoint, 2u);
  EXPECT_EQ(matches[0].distance, 7);
  EXPECT_EQ(matches[2].keypoint, 1u);
  EXPECT_EQ(matches[2].distance, 20);
}

TEST(KeepBestPerKeypoint, AcceptsEmptyInput) {
  std::vector<Match> matches;
  KeepBestPerKeypoint(matches);
  EXPECT_TRUE(matches.empty());
}

TEST(KeepBestPerKeypoint, DoesNotDependOnTheOrderOfItsInput) {
  std::mt19937 random(1);
  std::vector<Match> matches;
  for (uint32_t query = 0; query < 200; ++query) {
    matches.push_back(
        {query, static_cast<uint32_t>(random() % 50), static_cast<int>(random() % 9)});
  }
  std::vector<Match> first = matches;
  KeepBestPerKeypoint(first);
  std::shuffle(matches.begin(), matches.end(), random);
  KeepBestPerKeypoint(matches);
  ASSERT_EQ(Queries(first), Queries(matches));
  std::set<uint32_t> keypoints;
  for (const Match& match : first) {
    EXPECT_TRUE(keypoints.insert(match.keypoint).second);
  }
}

TEST(KeepConsistentRotations, LeavesOutOutliers) {
  EXPECT_EQ(KeptOf(Repeated({{36.0f, 20}, {180.0f, 1}})), Range(0, 20));
}

TEST(KeepConsistentRotations, KeepsThreeBinsUnlessBelowATenthOfTheFirst) {
  // The first bin has 30 matches, the second 10, the third 3 (a tenth), and a fourth one 2.
  EXPECT_EQ(KeptOf(Repeated({{0.0f, 30}, {48.0f, 10}, {120.0f, 3}, {240.0f, 2}})), Range(0, 43));
  // The first bin has 31 matches: 3 are less than a tenth.
  EXPECT_EQ(KeptOf(Repeated({{0.0f, 31}, {48.0f, 10}, {120.0f, 3}})), Range(0, 41));
}

TEST(KeepConsistentRotations, BinsAreCentredOnTheirAngles) {
  // Changes near zero are not split between two bins: 1 and 359 degrees are in the same bin, 7 is
  // in another.
  const std::vector<float> changes = Repeated({{1.0f, 10}, {359.0f, 10}, {-5.0f, 10}, {7.0f, 2}});
  EXPECT_EQ(KeptOf(changes), Range(0, 30));
}

TEST(KeepConsistentRotations, FullTurnsAndACommonTurnChangeNothing) {
  const std::vector<float> changes =
      Repeated({{3.0f, 30}, {50.0f, 12}, {121.0f, 5}, {241.0f, 4}, {301.0f, 1}});
  const std::vector<uint32_t> kept = KeptOf(changes);
  EXPECT_EQ(kept, Range(0, 47));
  for (const float turn : {360.0f, -720.0f, 12.0f, 96.0f, -132.0f}) {
    EXPECT_EQ(KeptOf(changes, turn), kept) << turn;
  }
}

TEST(KeepConsistentRotations, AcceptsEmptyInput) { EXPECT_TRUE(KeptOf({}).empty()); }

}  // namespace
}  // namespace hullslam
