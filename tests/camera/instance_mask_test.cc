// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/camera/instance_mask.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

// What a source does not say must not make a mask look worse or other than it is.
TEST(InstanceMask, IsASureContourUnlessSaidOtherwise) {
  const InstanceMask mask;
  EXPECT_EQ(mask.score, 1.0);
  EXPECT_EQ(mask.shape, MaskShape::kContour);
  EXPECT_TRUE(mask.outlines.empty());
}

}  // namespace
}  // namespace hullslam
