// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hullslam {
namespace {

TEST(Median, IsTheMiddleValueInAnyOrder) {
  EXPECT_EQ(Median(std::vector{5.0}), 5.0);
  EXPECT_EQ(Median(std::vector{9.0, 1.0, 5.0}), 5.0);
  EXPECT_EQ(Median(std::vector{3, 3, 1, 3, 7}), 3);
}

TEST(Median, OfAnEvenNumberIsTheLargerOfTheMiddleTwo) {
  EXPECT_EQ(Median(std::vector{4.0, 1.0, 3.0, 2.0}), 3.0);
}

TEST(ReachedBy, IsTheLargestValueThatThisShareReaches) {
  const std::vector<int> values = {7, 1, 8, 2, 6, 3, 5, 4};
  EXPECT_EQ(ReachedBy(0.25, values), 7);
  EXPECT_EQ(ReachedBy(0.75, values), 3);
  EXPECT_EQ(ReachedBy(1.0, values), 1);
  EXPECT_EQ(ReachedBy(0.0, values), 8);
}

TEST(ReachedBy, OfAHalfIsTheMedian) {
  for (const std::vector<int>& values : {std::vector{4, 1, 3, 2}, {3, 9, 4}, {2}}) {
    EXPECT_EQ(ReachedBy(0.5, values), Median(values));
  }
}

// With q = x / 2, P(chi2 > x) is erfc(sqrt(q)) for one degree of freedom, exp(-q) for two and
// erfc(sqrt(q)) + 2 sqrt(q / pi) exp(-q) for three.
TEST(Chi2Bound, LeavesFivePercentAbove) {
  const auto above_one = [](double x) { return std::erfc(std::sqrt(0.5 * x)); };
  EXPECT_NEAR(above_one(Chi2Bound(1)), 0.05, 1e-4);
  EXPECT_NEAR(std::exp(-0.5 * Chi2Bound(2)), 0.05, 1e-4);
  const double x = Chi2Bound(3);
  EXPECT_NEAR(above_one(x) + std::sqrt(2.0 * x / std::numbers::pi) * std::exp(-0.5 * x), 0.05,
              1e-4);
}

TEST(Chi2Bound, IsKnownForOneToThreeDegreesOfFreedom) {
  EXPECT_THROW(Chi2Bound(0), std::out_of_range);
  EXPECT_THROW(Chi2Bound(4), std::out_of_range);
}

}  // namespace

}  // namespace hullslam
