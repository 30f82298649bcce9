// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/detection.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(Detection, IsUncutWithScoreOneAndWithoutOutlineAtFirst) {
  const Detection detection;
  EXPECT_EQ(detection.score, 1.0);
  EXPECT_FALSE(detection.is_cut);
  EXPECT_FALSE(detection.is_box);
  EXPECT_FALSE(detection.ellipse.has_value());
  EXPECT_TRUE(detection.box.isEmpty());
}

}  // namespace
}  // namespace hullslam
