// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/hash_noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hullslam::synthetic {
namespace {

TEST(CounterHash, IsSplitMix64) {
  // The first outputs of the reference implementation for state 0.
  EXPECT_EQ(CounterHash(0, 0), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(CounterHash(0, 1), 0x6e789e6aa1b965f4ULL);
}

TEST(UnitInterval, CoversZeroToBelowOne) {
  EXPECT_EQ(UnitInterval(0), 0.0);
  EXPECT_LT(UnitInterval(~uint64_t{0}), 1.0);
  EXPECT_EQ(UnitInterval(uint64_t{1} << 63), 0.5);
}

TEST(RandomStream, StaysWithinItsBounds) {
  RandomStream random(5);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.Uniform(-2.0, 3.0);
    EXPECT_GE(value, -2.0);
    EXPECT_LT(value, 3.0);
    const int index = random.Index(7);
    EXPECT_GE(index, 0);
    EXPECT_LT(index, 7);
  }
}

TEST(NormalTable, HasTheMomentsOfTheNormalDistribution) {
  const NormalTable normal;
  double sum = 0.0;
  double squares = 0.0;
  int below_one_sigma = 0;
  for (uint64_t i = 0; i < 4096; ++i) {
    sum += normal(i);
    squares += static_cast<double>(normal(i)) * normal(i);
    below_one_sigma += std::abs(normal(i)) < 1.0F ? 1 : 0;
  }
  EXPECT_NEAR(sum / 4096.0, 0.0, 1e-6);
  EXPECT_NEAR(squares / 4096.0, 1.0, 2e-3);
  EXPECT_NEAR(below_one_sigma / 4096.0, 0.6827, 1e-3);
  EXPECT_EQ(normal(4096 + 17), normal(17));
}

}  // namespace
}  // namespace hullslam::synthetic
