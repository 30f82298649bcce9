// SPDX-License-Identifier: GPL-3.0-or-later
#include "places/depth_agreement.h"

#include <gtest/gtest.h>

#include <opencv2/core/mat.hpp>

#include "frame/wall_frame.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// The same with a thing 1 m away in the middle of the image.
Frame ThingFrame() {
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(kWall));
  depth(cv::Rect(200, 120, 240, 240)) = 1000;
  Frame frame;
  frame.depth = DepthGrid(depth, 1000.0);
  return frame;
}

TEST(DepthAgreement, TwoViewsOfOneWallAgree) {
  const Sensor sensor = SyntheticSensor();
  const Rigid3 aside(Eigen::Quaterniond::Identity(), {0.3, 0.0, 0.0});
  const DepthAgreement agreement = CompareDepths(sensor, WallFrame(), WallFrame(), aside);
  EXPECT_GT(agreement.surface, 1000);
  EXPECT_EQ(agreement.past, 0);
}

// Whichever of the two cameras sees past the thing, its place is empty in one of the images.
TEST(DepthAgreement, AThingThatOnlyOneViewShowsIsCounted) {
  const Sensor sensor = SyntheticSensor();
  const DepthAgreement one = CompareDepths(sensor, ThingFrame(), WallFrame(), Rigid3());
  const DepthAgreement other = CompareDepths(sensor, WallFrame(), ThingFrame(), Rigid3());
  EXPECT_GT(one.past, 150);
  EXPECT_EQ(one.past, other.past);
  EXPECT_EQ(one.surface, other.surface);
}

TEST(DepthAgreement, AWrongPoseOrAWrongDistanceIsContradicted) {
  const Sensor sensor = SyntheticSensor();
  const Rigid3 ahead(Eigen::Quaterniond::Identity(), {0.0, 0.0, -0.5});
  const DepthAgreement wrong = CompareDepths(sensor, WallFrame(), WallFrame(), ahead);
  EXPECT_GT(wrong.past, wrong.surface);
  const DepthAgreement right = CompareDepths(sensor, WallFrame(), WallFrame(kWall - 500), ahead);
  EXPECT_EQ(right.past, 0);
}

TEST(DepthAgreement, WithoutDepthNothingIsCompared) {
  EXPECT_EQ(CompareDepths(SyntheticSensor(), WallFrame(), Frame(), Rigid3()).compared(), 0);
}

}  // namespace
}  // namespace hullslam
