// SPDX-License-Identifier: GPL-3.0-or-later

#include "util/order_statistics.h"

#include <gtest/gtest.h>

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

}  // namespace

}  // namespace hullslam
