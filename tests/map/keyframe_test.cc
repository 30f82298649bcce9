// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/keyframe.h"

#include <gtest/gtest.h>

#include "map/made_map.h"

namespace hullslam {
namespace {

TEST(Keyframe, HasNoLinksAtFirst) {
  const Keyframe keyframe;
  EXPECT_EQ(keyframe.frame, nullptr);
  EXPECT_FALSE(keyframe.parent.IsValid());
  EXPECT_TRUE(keyframe.children.empty());
  EXPECT_TRUE(keyframe.covisible.empty());
  EXPECT_FALSE(Covisible().keyframe.IsValid());
  EXPECT_TRUE(keyframe.loops.empty());
  EXPECT_EQ(keyframe.scale, 1.0);
  EXPECT_FALSE(CulledKeyframe().pose.reference.IsValid());
  EXPECT_EQ(CulledKeyframe().scale, 1.0);
}

// The features of an image are large; copying a keyframe, as snapshots do, must not copy them.
TEST(Keyframe, CopiesShareTheirFrame) {
  Keyframe keyframe;
  keyframe.frame = MakeFrame(1, 10);
  const Keyframe copy = keyframe;
  EXPECT_EQ(copy.frame.get(), keyframe.frame.get());
}

}  // namespace
}  // namespace hullslam
