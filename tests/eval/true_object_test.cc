// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/true_object.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(TrueObject, SizeIsTheMeanFullExtentForAnyPose) {
  TrueObject object;
  object.half_extents = {0.1, 0.2, 0.6};
  EXPECT_NEAR(object.Size(), 0.6, 1e-15);
  object.world_from_object = Rigid3(ExpSo3({1.0, 2.0, 3.0}), {4.0, 5.0, 6.0});
  EXPECT_NEAR(object.Size(), 0.6, 1e-15);
}

}  // namespace
}  // namespace hullslam
