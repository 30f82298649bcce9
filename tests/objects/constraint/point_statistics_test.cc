// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/point_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hullslam/util/check.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

TEST(PointStatistics, MeanByHandAndOfNothing) {
  const std::vector<Eigen::Vector3d> points = {{1.0, 2.0, 3.0}, {3.0, 2.0, -6.0}};
  EXPECT_EQ(MeanOf(points), Eigen::Vector3d(2.0, 2.0, -1.5));
  EXPECT_EQ(MeanOf({}), Eigen::Vector3d::Zero());
}

TEST(RankSum, IsAsComputedByHandForSamplesOfDifferentSizes) {
  // Ranks of a: 1, 2, 4; sum 7; mean 3 * 8 / 2 = 12; variance 3 * 4 * 8 / 12 = 8.
  const std::vector<double> a = {0.1, 0.2, 0.4};
  const std::vector<double> b = {0.3, 0.5, 0.6, 0.7};
  EXPECT_NEAR(RankSumScore(a, b), (7.0 - 12.0) / std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(RankSumScore(b, a), -RankSumScore(a, b), 1e-12);
}

TEST(RankSum, TiesShareRanks) {
  const std::vector<double> same = {1.0, 1.0, 1.0};
  EXPECT_DOUBLE_EQ(RankSumScore(same, same), 0.0);
  EXPECT_THROW(RankSumScore({}, same), CheckError);
}

TEST(RankSum, StaysWithinItsBoundAsOftenAsItShould) {
  RandomGeometry random(7);
  int within = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<double> a;
    std::vector<double> b;
    for (int i = 0; i < 25; ++i) {
      a.push_back(random.Number(0.0, 1.0));
    }
    for (int i = 0; i < 40; ++i) {
      b.push_back(random.Number(0.0, 1.0));
    }
    within += std::abs(RankSumScore(a, b)) <= 1.282 ? 1 : 0;
  }
  EXPECT_NEAR(within, 800, 45);  // 80 % of a normal distribution
}

std::vector<Eigen::Vector3d> Cloud(RandomGeometry& random, const Eigen::Vector3d& center,
                                   int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(center + random.Vector(0.1));
  }
  return points;
}

TEST(Clouds, MayBeOneIfTheyOverlapButNotIfTheyAreApart) {
  RandomGeometry random(3);
  const auto here = Cloud(random, {1.0, 2.0, 3.0}, 60);
  const auto there = Cloud(random, {1.0, 2.2, 3.0}, 40);
  EXPECT_TRUE(MayBeOneCloud(here, here, 1.282, 20));
  EXPECT_FALSE(MayBeOneCloud(here, there, 1.282, 20));
  EXPECT_FALSE(MayBeOneCloud(here, here, 1.282, 61));  // too few to say
  EXPECT_FALSE(MayBeOneCloud(here, std::span(here).first(19), 100.0, 20));
  EXPECT_FALSE(MayBeOneCloud(std::span(here).first(19), here, 100.0, 20));
  EXPECT_TRUE(MayBeOneCloud(std::span(here).first(20), here, 100.0, 20));
}

TEST(Means, AreTestedWithTheNoiseOfTheSensor) {
  RandomGeometry random(5);
  const auto samples = Cloud(random, {0.0, 0.0, 1.0}, 8);
  EXPECT_TRUE(MayBeTheMean({0.0, 0.0, 1.05}, samples, 0.001, 0.02));
  EXPECT_FALSE(MayBeTheMean({0.0, 1.0, 1.0}, samples, 0.001, 0.02));
  // If samples agree to a micrometre by chance, the test must not become that strict.
  const std::vector<Eigen::Vector3d> equal(5, Eigen::Vector3d(0.0, 0.0, 1.0));
  EXPECT_TRUE(MayBeTheMean({0.01, 0.0, 1.0}, equal, 0.001, 0.02));
  EXPECT_FALSE(MayBeTheMean({0.0, 0.0, 1.0}, std::span(equal).first(2), 0.001, 0.02));
}

// Mean 0, variance 4/3, n = 4: the bound is 3.182 * sqrt(4/3 * 5/4) = 4.108 (3.182: Student's t of
// 3 degrees of freedom at 5 %).
TEST(Means, AValueVariesAsMuchAsASample) {
  const std::vector<Eigen::Vector3d> samples = {
      Eigen::Vector3d::Constant(-1.0), Eigen::Vector3d::Constant(1.0),
      Eigen::Vector3d::Constant(-1.0), Eigen::Vector3d::Constant(1.0)};
  EXPECT_TRUE(MayBeTheMean({4.05, 0.0, 0.0}, samples, 0.05, 0.0));
  EXPECT_FALSE(MayBeTheMean({4.15, 0.0, 0.0}, samples, 0.05, 0.0));
}

TEST(Means, OfTwoSamplesAreOneOrNot) {
  RandomGeometry random(9);
  const auto a = Cloud(random, {0.0, 0.0, 1.0}, 10);
  const auto b = Cloud(random, {0.0, 0.0, 1.0}, 20);
  const auto c = Cloud(random, {0.3, 0.0, 1.0}, 20);
  EXPECT_TRUE(MayHaveOneMean(a, b, 0.05, 0.02));
  EXPECT_FALSE(MayHaveOneMean(a, c, 0.05, 0.02));
  EXPECT_FALSE(MayHaveOneMean(a, std::span(b).first(2), 0.05, 0.02));
}

TEST(RankSum, TiesBetweenTheSamplesHaveTheMeanOfTheirRanks) {
  // Ranks of a: 1 and (2 + 3) / 2; sum 3.5; mean 2 * 5 / 2 = 5; variance 2 * 2 * 5 / 12 = 5 / 3.
  EXPECT_NEAR(RankSumScore(std::vector{1.0, 2.0}, std::vector{2.0, 3.0}),
              -1.5 / std::sqrt(5.0 / 3.0), 1e-12);
}

// Student's t of 4 degrees of freedom at 0.1 % is 8.610; the bound is 8.610 * 0.02 * sqrt(6 / 5).
TEST(Means, TheNoiseOfTheSensorIsAStandardDeviation) {
  const std::vector<Eigen::Vector3d> equal(5, Eigen::Vector3d::Zero());
  EXPECT_TRUE(MayBeTheMean({0.0, 0.0, 0.187}, equal, 0.001, 0.02));
  EXPECT_FALSE(MayBeTheMean({0.0, 0.0, 0.190}, equal, 0.001, 0.02));
}

// Both samples have the variance 4/3 and four members, so the variance of the difference is 2/3 and
// the degrees of freedom are 6, for which Student's t at 5 % is 2.447. With the noise 1 each
// variance is 7/3, that of the difference 7/6.
TEST(Means, OfTwoSamplesDifferByTheirStandardErrors) {
  const auto may_be = [](double shift, double noise) {
    std::vector<Eigen::Vector3d> a;
    std::vector<Eigen::Vector3d> b;
    for (const double value : {-1.0, 1.0, -1.0, 1.0}) {
      a.push_back(Eigen::Vector3d::Constant(value));
      b.push_back(Eigen::Vector3d(value, value, value + shift));
    }
    return MayHaveOneMean(a, b, 0.05, noise);
  };
  EXPECT_TRUE(may_be(2.447 * std::sqrt(2.0 / 3.0) - 0.01, 0.0));
  EXPECT_FALSE(may_be(2.447 * std::sqrt(2.0 / 3.0) + 0.01, 0.0));
  EXPECT_TRUE(may_be(2.447 * std::sqrt(7.0 / 6.0) - 0.01, 1.0));
  EXPECT_FALSE(may_be(2.447 * std::sqrt(7.0 / 6.0) + 0.01, 1.0));
}

}  // namespace
}  // namespace hullslam
