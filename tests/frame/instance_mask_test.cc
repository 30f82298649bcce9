// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/instance_mask.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(InstanceMask, IsACertainContourUnlessSaidOtherwise) {
  const InstanceMask mask;
  EXPECT_EQ(mask.shape, MaskShape::kContour);
  EXPECT_EQ(mask.score, 1.0);
  EXPECT_TRUE(mask.outlines.empty());
}

}  // namespace
}  // namespace hullslam
