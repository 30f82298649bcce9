// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/frame_chooser.h"

#include <gtest/gtest.h>

#include <vector>

#include "hullslam/geometry/trajectory.h"
#include "support/square_mask.h"

namespace hullslam {
namespace {

// A chooser of views 0.1 m or 10 degrees apart that was given a first frame at the origin with a
// cup of 20 px at x = 100 px.
class ViewChooserTest : public ::testing::Test {
 protected:
  ViewChooserTest() { EXPECT_TRUE(Choose(0.0, {Square("cup", 100, 100, 20)})); }

  bool Choose(double metres, const std::vector<InstanceMask>& masks, double degrees = 0.0) {
    const Rigid3 pose(ExpSo3({0.0, degrees * 3.141592653589793 / 180.0, 0.0}), {metres, 0.0, 0.0});
    return chooser_.Choose(pose, [&] {
      ++reads_;
      return masks;
    });
  }

  FrameChooser chooser_{{.min_distance = 0.1, .min_angle = 10.0}};
  int reads_ = 0;
};

TEST_F(ViewChooserTest, AFrameIsChosenWhenTheCameraHasMovedOrTurnedSinceTheLastChosenOne) {
  const std::vector<InstanceMask> masks = {Square("cup", 100, 100, 20)};
  EXPECT_FALSE(Choose(0.09, masks));
  EXPECT_TRUE(Choose(0.11, masks));
  EXPECT_FALSE(Choose(0.2, masks)) << "0.09 m from the last chosen one";
  EXPECT_FALSE(Choose(0.11, masks, 9.0));
  EXPECT_TRUE(Choose(0.11, masks, 11.0));
}

TEST_F(ViewChooserTest, AQuarterIsEnoughIfAMaskHasMovedByHalfOfItsSizeOrIsNew) {
  EXPECT_FALSE(Choose(0.03, {Square("cup", 109, 100, 20)}));
  EXPECT_FALSE(Choose(0.02, {Square("cup", 150, 100, 20)})) << "less than a quarter";
  EXPECT_TRUE(Choose(0.03, {Square("cup", 111, 100, 20)}));
  EXPECT_FALSE(Choose(0.06, {Square("cup", 112, 100, 20)})) << "compared with the last chosen one";
  EXPECT_TRUE(Choose(0.06, {Square("cup", 112, 100, 20), Square("book", 10, 10, 20)}));
  EXPECT_FALSE(Choose(0.09, {})) << "a mask that is gone is no reason";
}

TEST_F(ViewChooserTest, MasksAreReadOnlyIfTheyMatter) {
  EXPECT_EQ(reads_, 1);
  Choose(0.02, {});
  EXPECT_EQ(reads_, 1);
  Choose(0.03, {});
  EXPECT_EQ(reads_, 2);
}

TEST(ChooseViews, LeavesFramesWithoutAPoseOut) {
  const Trajectory poses = {{1.0, Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.0})},
                            {2.0, Rigid3(Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0})}};
  const ChosenViews chosen =
      ChooseViews(std::vector<double>{0.5, 1.0, 1.05, 1.5, 2.5}, poses, 1.0, {.min_distance = 0.1},
                  [](size_t) { return std::vector<InstanceMask>(); });
  EXPECT_EQ(chosen.without_pose, 2U);
  ASSERT_EQ(chosen.views.size(), 2U);
  EXPECT_EQ(chosen.views[0].frame, 1U);
  EXPECT_EQ(chosen.views[1].frame, 3U);
  EXPECT_EQ(chosen.views[1].world_from_cam.translation.x(), 0.5);
}

}  // namespace
}  // namespace hullslam
