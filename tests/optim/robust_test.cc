// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/robust.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace hullslam {
namespace {

// P(chi2 > x) is exp(-x / 2) with two degrees of freedom, and erfc(sqrt(x / 2)) +
// sqrt(2 x / pi) exp(-x / 2) with three.
TEST(Chi2Bounds, LeaveFivePercentOutside) {
  EXPECT_NEAR(std::exp(-0.5 * kChi2Mono), 0.05, 1e-4);
  const double outside = std::erfc(std::sqrt(0.5 * kChi2Rgbd)) +
                         std::sqrt(2.0 * kChi2Rgbd / std::numbers::pi) * std::exp(-0.5 * kChi2Rgbd);
  EXPECT_NEAR(outside, 0.05, 1e-4);
}

TEST(HuberWeight, IsOneInsideAndFallsAsTheErrorGrows) {
  EXPECT_EQ(HuberWeight(0.0, 4.0), 1.0);
  EXPECT_EQ(HuberWeight(4.0, 4.0), 1.0);
  EXPECT_EQ(HuberWeight(16.0, 4.0), 0.5);
  EXPECT_EQ(HuberWeight(400.0, 4.0), 0.1);
}

// Outside the bound the pull of an error, weight times error, does not grow.
TEST(HuberWeight, BoundsThePullOfAnError) {
  for (const double chi2 : {6.0, 10.0, 1e3, 1e9}) {
    EXPECT_NEAR(HuberWeight(chi2, kChi2Mono) * std::sqrt(chi2), std::sqrt(kChi2Mono), 1e-9);
  }
}

TEST(HuberWeight, OfAnInfiniteErrorIsZero) {
  EXPECT_EQ(HuberWeight(std::numeric_limits<double>::infinity(), 4.0), 0.0);
}

}  // namespace
}  // namespace hullslam
