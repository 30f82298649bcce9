// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/bow/bow_vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace hullslam {
namespace {

BowVector RandomVector(std::mt19937& random) {
  std::map<uint32_t, double> weights;
  double sum = 0.0;
  for (int i = 0; i < 20; ++i) {
    const double weight = 0.1 + random() % 100;
    sum += weight;
    weights[random() % 50] += weight;
  }
  BowVector vector;
  for (const auto& [word, weight] : weights) {
    vector.push_back({WordId(word), static_cast<float>(weight / sum)});
  }
  return vector;
}

// 1 - |v - w|_1 / 2, word by word.
double ScoreByDefinition(const BowVector& v, const BowVector& w) {
  std::map<uint32_t, double> difference;
  for (const WeightedWord& weighted : v) {
    difference[weighted.word.value] += static_cast<double>(weighted.weight);
  }
  for (const WeightedWord& weighted : w) {
    difference[weighted.word.value] -= static_cast<double>(weighted.weight);
  }
  double norm = 0.0;
  for (const auto& [word, value] : difference) {
    norm += std::abs(value);
  }
  return 1.0 - norm / 2.0;
}

TEST(Score, IsOneMinusHalfTheL1Distance) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const BowVector v = RandomVector(random);
    const BowVector w = RandomVector(random);
    EXPECT_NEAR(Score(v, w), ScoreByDefinition(v, w), 1e-6);
    EXPECT_EQ(Score(v, w), Score(w, v));
    EXPECT_NEAR(Score(v, v), 1.0, 1e-6);
  }
}

TEST(Score, ByHand) {
  const BowVector v = {{WordId(1), 0.25f}, {WordId(4), 0.75f}};
  const BowVector w = {{WordId(2), 0.5f}, {WordId(4), 0.5f}};
  EXPECT_DOUBLE_EQ(Score(v, w), 0.5);
}

TEST(Score, WithoutCommonWordsIsZero) {
  EXPECT_EQ(Score({{WordId(1), 1.0f}}, {{WordId(2), 1.0f}}), 0.0);
  EXPECT_EQ(Score({}, {{WordId(2), 1.0f}}), 0.0);
  EXPECT_EQ(Score({}, {}), 0.0);
}

}  // namespace
}  // namespace hullslam
