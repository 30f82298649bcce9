// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/error_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hullslam {
namespace {

TEST(ErrorStatistics, MatchHandComputedValues) {
  const ErrorStatistics statistics = SummarizeErrors({4.0, 1.0, 3.0, 2.0});
  EXPECT_DOUBLE_EQ(statistics.rmse, std::sqrt(30.0 / 4.0));
  EXPECT_DOUBLE_EQ(statistics.mean, 2.5);
  EXPECT_DOUBLE_EQ(statistics.median, 2.5);
  EXPECT_DOUBLE_EQ(statistics.max, 4.0);
  EXPECT_DOUBLE_EQ(SummarizeErrors({9.0, 1.0, 2.0}).median, 2.0);
}

TEST(ErrorStatistics, OfAnEmptyListAreZero) {
  const ErrorStatistics statistics = SummarizeErrors({});
  EXPECT_EQ(statistics.rmse, 0.0);
  EXPECT_EQ(statistics.mean, 0.0);
  EXPECT_EQ(statistics.median, 0.0);
  EXPECT_EQ(statistics.max, 0.0);
}

}  // namespace
}  // namespace hullslam
