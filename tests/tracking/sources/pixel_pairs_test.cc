// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sources/pixel_pairs.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(MakePixelPairs, EachMatchGivesItsPixelsAndTheScaleOfTheirLevels) {
  FrameFeatures a;
  FrameFeatures b;
  for (FrameFeatures* const features : {&a, &b}) {
    features->keypoints.resize(3);
  }
  a.keypoints[2].undistorted = {10.0f, 20.0f};
  a.keypoints[2].level = 0;
  b.keypoints[1].undistorted = {30.0f, 40.0f};
  b.keypoints[1].level = 2;
  const std::vector<Match> matches = {{.query = 2, .keypoint = 1}};
  const std::vector<PixelPair> pairs = MakePixelPairs(a, b, matches, ScaleLevels::Create(3, 1.2));
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].a, Eigen::Vector2d(10.0, 20.0));
  EXPECT_EQ(pairs[0].b, Eigen::Vector2d(30.0, 40.0));
  EXPECT_EQ(pairs[0].sigma_a, 1.0);
  EXPECT_NEAR(pairs[0].sigma_b, 1.44, 1e-6);
}

}  // namespace
}  // namespace hullslam
