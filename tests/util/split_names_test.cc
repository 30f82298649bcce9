// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/split_names.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace hullslam {
namespace {

TEST(SplitNames, TakesBlanksOffAndLeavesEmptyOnesOut) {
  EXPECT_EQ(SplitNames("person"), std::set<std::string>{"person"});
  EXPECT_EQ(SplitNames(" person , potted plant,,"),
            (std::set<std::string>{"person", "potted plant"}));
  EXPECT_TRUE(SplitNames("").empty());
  EXPECT_TRUE(SplitNames(" ").empty());
}

}  // namespace
}  // namespace hullslam
