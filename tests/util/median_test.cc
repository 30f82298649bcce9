// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/median.h"

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

}  // namespace
}  // namespace hullslam
