// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/robust.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hullslam {
namespace {

TEST(HuberCost, IsSquareInsideAndLinearInTheErrorOutside) {
  EXPECT_EQ(HuberCost(0.0, 4.0), 0.0);
  EXPECT_EQ(HuberCost(4.0, 4.0), 4.0);
  EXPECT_EQ(HuberCost(16.0, 4.0), 12.0);
  EXPECT_EQ(HuberCost(64.0, 4.0), 28.0);
  EXPECT_EQ(HuberCost(std::numeric_limits<double>::infinity(), 4.0),
            std::numeric_limits<double>::infinity());
}

TEST(HuberCost, HasTheWeightAsDerivative) {
  for (const double chi2 : {1.0, 3.9, 4.1, 100.0}) {
    EXPECT_NEAR((HuberCost(chi2 + 1e-6, 4.0) - HuberCost(chi2 - 1e-6, 4.0)) / 2e-6,
                HuberWeight(chi2, 4.0), 1e-7);
  }
}

TEST(HuberWeight, IsOneInsideAndFallsAsTheErrorGrows) {
  EXPECT_EQ(HuberWeight(0.0, 4.0), 1.0);
  EXPECT_EQ(HuberWeight(4.0, 4.0), 1.0);
  EXPECT_EQ(HuberWeight(16.0, 4.0), 0.5);
  EXPECT_EQ(HuberWeight(400.0, 4.0), 0.1);
}

// Beyond the bound, weight times error (the gradient of the cost) does not grow.
TEST(HuberWeight, BoundsTheGradient) {
  for (const double chi2 : {6.0, 10.0, 1e3, 1e9}) {
    EXPECT_NEAR(HuberWeight(chi2, 4.0) * std::sqrt(chi2), 2.0, 1e-9);
  }
}

TEST(HuberWeight, OfAnInfiniteErrorIsZero) {
  EXPECT_EQ(HuberWeight(std::numeric_limits<double>::infinity(), 4.0), 0.0);
}

TEST(CauchyCost, IsSquareForSmallErrorsAndLogarithmicForLargeOnes) {
  EXPECT_EQ(CauchyCost(0.0, 4.0), 0.0);
  EXPECT_NEAR(CauchyCost(1e-3, 4.0), 1e-3, 1e-7);
  EXPECT_NEAR(CauchyCost(16.0, 4.0), 16.0 * std::log(2.0), 1e-12);
  EXPECT_NEAR(CauchyCost(1.6e13, 4.0), 16.0 * std::log(1e12), 1e-6);
}

TEST(CauchyCost, HasTheWeightAsDerivative) {
  for (const double chi2 : {1.0, 16.0, 100.0}) {
    EXPECT_NEAR((CauchyCost(chi2 + 1e-5, 4.0) - CauchyCost(chi2 - 1e-5, 4.0)) / 2e-5,
                CauchyWeight(chi2, 4.0), 1e-7);
  }
}

// The pull of an error, weight times error, is largest at the scale.
TEST(CauchyWeight, LetsLargeErrorsPullLess) {
  const auto pull = [](double error) { return error * CauchyWeight(error * error, 4.0); };
  EXPECT_GT(pull(4.0), pull(3.9));
  EXPECT_GT(pull(4.0), pull(4.1));
  EXPECT_LT(pull(40.0), pull(1.0));
}

}  // namespace
}  // namespace hullslam
