// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/sort_unique.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

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
