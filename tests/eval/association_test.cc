// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/association.h"

#include <gtest/gtest.h>

#include <vector>

namespace hullslam {
namespace {

Trajectory AtTimes(const std::vector<double>& stamps) {
  Trajectory trajectory;
  for (const double stamp : stamps) {
    trajectory.push_back({stamp, Rigid3()});
  }
  return trajectory;
}

TEST(Association, TumRuleIsOneToOneAndEvoRuleIsNot) {
  const Trajectory reference = AtTimes({1.000});
  const Trajectory estimate = AtTimes({0.996, 1.003});
  // The reference is the shorter trajectory, so evo looks for one pair only.
  EXPECT_EQ(PairPoses(reference, estimate, PairingRule::kEvo, 0.01),
            (std::vector<IndexPair>{{0, 1}}));
  const Trajectory two = AtTimes({0.996, 1.003});
  const Trajectory three = AtTimes({1.000, 2.0, 3.0});
  // Here the estimate is shorter, and both of its poses get the same partner.
  EXPECT_EQ(PairPoses(three, two, PairingRule::kEvo, 0.01),
            (std::vector<IndexPair>{{0, 0}, {0, 1}}));
  EXPECT_EQ(PairPoses(three, two, PairingRule::kTum, 0.01), (std::vector<IndexPair>{{0, 1}}));
}

TEST(Association, EvoUsesTheStampsOfTheEstimateForEqualLengths) {
  const Trajectory reference = AtTimes({1.000, 5.0});
  const Trajectory estimate = AtTimes({0.996, 1.003});
  EXPECT_EQ(PairPoses(reference, estimate, PairingRule::kEvo, 0.01),
            (std::vector<IndexPair>{{0, 0}, {0, 1}}));
}

TEST(Association, TheLimitIsInclusiveForEvoOnly) {
  const Trajectory reference = AtTimes({1.0, 2.0});
  const Trajectory estimate = AtTimes({1.5});
  EXPECT_EQ(PairPoses(reference, estimate, PairingRule::kEvo, 0.5).size(), 1U);
  EXPECT_TRUE(PairPoses(reference, estimate, PairingRule::kTum, 0.5).empty());
}

TEST(Association, EmptyTrajectoriesHaveNoPairs) {
  for (const PairingRule rule : {PairingRule::kTum, PairingRule::kEvo}) {
    EXPECT_TRUE(PairPoses({}, AtTimes({1.0}), rule, 1.0).empty());
    EXPECT_TRUE(PairPoses(AtTimes({1.0}), {}, rule, 1.0).empty());
  }
}

TEST(Association, RulesHaveTheNamesAndLimitsOfTheirTools) {
  EXPECT_STREQ(ToString(PairingRule::kTum), "tum");
  EXPECT_STREQ(ToString(PairingRule::kEvo), "evo");
  EXPECT_EQ(DefaultMaxDifference(PairingRule::kTum), 0.02);
  EXPECT_EQ(DefaultMaxDifference(PairingRule::kEvo), 0.01);
}

}  // namespace
}  // namespace hullslam
