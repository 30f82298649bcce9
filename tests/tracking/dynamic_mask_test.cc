// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/tracking/dynamic_mask.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

InstanceMask Square(const std::string& label, double left, double top, double side) {
  InstanceMask mask;
  mask.label = label;
  mask.outlines = {
      {{left, top}, {left + side, top}, {left + side, top + side}, {left, top + side}}};
  return mask;
}

TEST(SplitNames, TakesBlanksOffAndLeavesEmptyOnesOut) {
  EXPECT_EQ(SplitNames("person"), std::set<std::string>{"person"});
  EXPECT_EQ(SplitNames(" person , potted plant,,"),
            (std::set<std::string>{"person", "potted plant"}));
  EXPECT_TRUE(SplitNames("").empty());
  EXPECT_TRUE(SplitNames(" ").empty());
}

TEST(DynamicMask, CoversThingsOfTheClassesAndALittleMore) {
  const std::vector<InstanceMask> masks = {Square("person", 40, 40, 20), Square("cup", 5, 5, 10)};
  const cv::Mat mask = DynamicMask(masks, {"person"}, {100, 100});
  ASSERT_EQ(mask.size(), cv::Size(100, 100));
  EXPECT_EQ(mask.at<uchar>(50, 50), 255);
  EXPECT_EQ(mask.at<uchar>(50, 36), 255);
  EXPECT_EQ(mask.at<uchar>(50, 30), 0);
  EXPECT_EQ(mask.at<uchar>(10, 10), 0);
  EXPECT_TRUE(DynamicMask(masks, {"cat"}, {100, 100}).empty());
  EXPECT_TRUE(DynamicMask(masks, {}, {100, 100}).empty());
}

TEST(RemoveMasked, TakesKeypointsOutWithTheirDescriptors) {
  const cv::Mat mask =
      DynamicMask(std::vector{Square("person", 40, 40, 20)}, {"person"}, {100, 100});
  std::vector<Keypoint> keypoints(3);
  std::vector<Descriptor> descriptors(3);
  keypoints[0].raw = {10.0f, 10.0f};
  keypoints[1].raw = {50.0f, 50.0f};
  keypoints[2].raw = {90.0f, 50.0f};
  descriptors[2][0] = 7;
  RemoveMasked(mask, keypoints, descriptors);
  ASSERT_EQ(keypoints.size(), 2u);
  EXPECT_EQ(keypoints[1].raw.x(), 90.0f);
  EXPECT_EQ(descriptors[1][0], 7);
}

}  // namespace
}  // namespace hullslam
