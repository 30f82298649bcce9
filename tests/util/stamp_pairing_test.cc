// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/stamp_pairing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

TEST(StampPairing, TakesTheClosestPairFirst) {
  // 1.015 is near enough to both but closer to 1.02, so 1.00 is paired with 0.99.
  const std::vector<double> first = {1.00, 1.02};
  const std::vector<double> second = {0.99, 1.015};
  const std::vector<IndexPair> expected = {{0, 0}, {1, 1}};
  EXPECT_EQ(PairStampsGreedily(first, second, 0.02), expected);
}

TEST(StampPairing, AGreedyChoiceMayLeaveStampsUnpaired) {
  // The closest pair (1.012, 1.010) leaves 1.000 and 1.035 without a partner.
  const std::vector<double> first = {1.000, 1.012};
  const std::vector<double> second = {1.010, 1.035};
  const std::vector<IndexPair> expected = {{1, 0}};
  EXPECT_EQ(PairStampsGreedily(first, second, 0.02), expected);
}

TEST(StampPairing, TheLimitIsExclusive) {
  EXPECT_TRUE(PairStampsGreedily(std::vector<double>{1.0}, std::vector<double>{1.5}, 0.5).empty());
  EXPECT_EQ(PairStampsGreedily(std::vector<double>{1.0}, std::vector<double>{1.5}, 0.500001).size(),
            1U);
}

TEST(StampPairing, EmptyListsGiveNoPairs) {
  EXPECT_TRUE(PairStampsGreedily({}, std::vector<double>{1.0}, 1.0).empty());
  EXPECT_TRUE(PairStampsGreedily(std::vector<double>{1.0}, {}, 1.0).empty());
}

std::vector<double> RandomStamps(std::mt19937& generator, int count) {
  std::uniform_real_distribution<double> step(0.001, 0.06);
  std::vector<double> stamps(count);
  double time = 0.0;
  for (double& stamp : stamps) {
    stamp = time += step(generator);
  }
  return stamps;
}

TEST(StampPairing, IsOneToOneMaximalAndSymmetric) {
  std::mt19937 generator(3);
  const std::vector<double> first = RandomStamps(generator, 400);
  const std::vector<double> second = RandomStamps(generator, 350);
  const std::vector<IndexPair> pairs = PairStampsGreedily(first, second, 0.02);
  std::vector<int> first_uses(first.size());
  std::vector<int> second_uses(second.size());
  for (const IndexPair& pair : pairs) {
    EXPECT_LT(std::abs(first[pair.first] - second[pair.second]), 0.02);
    EXPECT_EQ(++first_uses[pair.first], 1);
    EXPECT_EQ(++second_uses[pair.second], 1);
  }
  for (size_t i = 0; i < first.size(); ++i) {
    for (size_t j = 0; j < second.size(); ++j) {
      const bool both_alone = first_uses[i] == 0 && second_uses[j] == 0;
      EXPECT_FALSE(both_alone && std::abs(first[i] - second[j]) < 0.02) << i << ' ' << j;
    }
  }
  std::vector<IndexPair> swapped = PairStampsGreedily(second, first, 0.02);
  for (IndexPair& pair : swapped) {
    std::swap(pair.first, pair.second);
  }
  // Pairs may cross in time, so sorting by the other list gives another order.
  std::sort(swapped.begin(), swapped.end(),
            [](const IndexPair& a, const IndexPair& b) { return a.first < b.first; });
  EXPECT_TRUE(swapped == pairs);
}

TEST(NearestStamp, FindsTheNearestAndTheEarlierOneOfATie) {
  const std::vector<double> stamps = {1.0, 2.0, 4.0};
  EXPECT_EQ(NearestStamp(stamps, -5.0), 0U);
  EXPECT_EQ(NearestStamp(stamps, 1.4), 0U);
  EXPECT_EQ(NearestStamp(stamps, 1.5), 0U);
  EXPECT_EQ(NearestStamp(stamps, 3.5), 2U);
  EXPECT_EQ(NearestStamp(stamps, 9.0), 2U);
  EXPECT_THROW(NearestStamp({}, 1.0), CheckError);
}

TEST(SmallestGap, IsTheSmallestDifferenceOfAllPairs) {
  EXPECT_DOUBLE_EQ(SmallestGap(std::vector<double>{1.0, 5.0}, std::vector<double>{2.0, 4.5}), 0.5);
  EXPECT_EQ(SmallestGap({}, std::vector<double>{2.0}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace hullslam
