// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/lists.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(Thin, ChoosesEvenly) {
  EXPECT_EQ(Thin(std::vector{0, 1, 2, 3, 4, 5, 6, 7, 8}, 3), (std::vector{0, 3, 6}));
  EXPECT_EQ(Thin(std::vector{0, 1, 2, 3, 4}, 4), (std::vector{0, 1, 2, 3}));
}

TEST(Thin, KeepsFewElements) {
  EXPECT_EQ(Thin(std::vector{4, 2}, 2), (std::vector{4, 2}));
  EXPECT_EQ(Thin(std::vector{4, 2}, 9), (std::vector{4, 2}));
}

TEST(Thin, AnEmptyListStaysEmpty) {
  EXPECT_TRUE(Thin(std::vector{4, 2}, 0).empty());
  EXPECT_TRUE(Thin(std::vector<int>(), 3).empty());
}

TEST(EveryKth, HasEqualSteps) {
  EXPECT_EQ(EveryKth(std::vector{0, 1, 2, 3, 4, 5, 6}, 3), (std::vector{0, 3, 6}));
  EXPECT_EQ(EveryKth(std::vector{0, 1, 2, 3, 4}, 4), (std::vector{0, 2, 4}));
  EXPECT_EQ(EveryKth(std::vector{4, 2}, 9), (std::vector{4, 2}));
  EXPECT_TRUE(EveryKth(std::vector{4, 2}, 0).empty());
  EXPECT_TRUE(EveryKth(std::vector<int>(), 3).empty());
}

TEST(SortUnique, LeavesEachValueOnceInOrder) {
  std::vector<int> values = {3, 1, 3, 2, 1};
  SortUnique(values);
  EXPECT_EQ(values, (std::vector<int>{1, 2, 3}));
  std::vector<int> none;
  SortUnique(none);
  EXPECT_TRUE(none.empty());
}

}  // namespace

}  // namespace hullslam
