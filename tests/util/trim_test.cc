// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/trim.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(Trim, RemovesBlanksAtBothEndsOnly) {
  EXPECT_EQ(Trim(" \t potted plant\r"), "potted plant");
  EXPECT_EQ(Trim("cup"), "cup");
  EXPECT_EQ(Trim(" \t\r"), "");
  EXPECT_EQ(Trim(""), "");
}

}  // namespace
}  // namespace hullslam
