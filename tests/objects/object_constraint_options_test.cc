// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_constraint_options.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(RobustLossNames, OneForEachEnumerator) {
  const std::vector<std::string> names = RobustLossNames();
  ASSERT_EQ(names.size(), static_cast<size_t>(RobustLoss::kTukey) + 1);
  EXPECT_EQ(names[static_cast<size_t>(RobustLoss::kNone)], "none");
  EXPECT_EQ(names[static_cast<size_t>(RobustLoss::kTukey)], "tukey");
}

}  // namespace
}  // namespace hullslam
