// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/counted.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(Counted, OnlyOneIsSingular) {
  EXPECT_EQ(Counted(0, "keyframe"), "0 keyframes");
  EXPECT_EQ(Counted(1, "keyframe"), "1 keyframe");
  EXPECT_EQ(Counted(21, "image"), "21 images");
}

}  // namespace
}  // namespace hullslam
