// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/edit_distance.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(EditDistance, CountsInsertedRemovedAndReplacedCharacters) {
  EXPECT_EQ(EditDistance("voom", "voom"), 0u);
  EXPECT_EQ(EditDistance("vom", "voom"), 1u);
  EXPECT_EQ(EditDistance("voom", "vom"), 1u);
  EXPECT_EQ(EditDistance("orbslam2", "orb_slam2"), 1u);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);
}

TEST(EditDistance, TheEmptyTextNeedsAllCharacters) {
  EXPECT_EQ(EditDistance("", ""), 0u);
  EXPECT_EQ(EditDistance("", "abc"), 3u);
  EXPECT_EQ(EditDistance("abc", ""), 3u);
}

TEST(EditDistance, AMisspeltNameIsSimilarAndDiffersNotOnlyInNumbers) {
  EXPECT_TRUE(IsMisspelt("Camera.fxx", "Camera.fx"));
  EXPECT_TRUE(IsMisspelt("objects.start.min_view", "objects.start.min_views"));
  EXPECT_TRUE(IsMisspelt("lenght", "length"));
  EXPECT_FALSE(IsMisspelt("PointCloudMapping.Resolution", "objects.start.inflation"));
  EXPECT_FALSE(IsMisspelt("is", "tv"));
  EXPECT_FALSE(IsMisspelt("my", "cup"));
  EXPECT_TRUE(IsMisspelt("boat", "book"));
  EXPECT_FALSE(IsMisspelt("Camera.k4", "Camera.bf"));
  EXPECT_FALSE(IsMisspelt("Camera.k4", "Camera.k1"));
  EXPECT_FALSE(IsMisspelt("Camera2.fx", "Camera.fx"));
}

TEST(EditDistance, IsSymmetric) {
  EXPECT_EQ(EditDistance("quadric", "quartic"), EditDistance("quartic", "quadric"));
}

}  // namespace
}  // namespace hullslam
