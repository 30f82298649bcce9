// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/dynamic_mask.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "support/square_mask.h"

namespace hullslam {
namespace {

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

TEST(DynamicMask, GrowsBySevenPixelsToEverySideAndUpToTheBorder) {
  const std::vector<InstanceMask> masks = {
      Square("person", -5, 40, 10), Square("person", 60, 70, 0), Square("person", 85, 85, 30),
      Square("person", 300, 5, 9)};
  const cv::Mat mask = DynamicMask(masks, {"person"}, {100, 100});
  cv::Mat expected = cv::Mat::zeros(100, 100, CV_8UC1);
  expected(cv::Rect(cv::Point(0, 33), cv::Point(13, 58))) = 255;
  expected(cv::Rect(cv::Point(53, 63), cv::Point(68, 78))) = 255;
  expected(cv::Rect(cv::Point(78, 78), cv::Point(100, 100))) = 255;
  EXPECT_EQ(cv::countNonZero(mask != expected), 0);
  const cv::Mat outside =
      DynamicMask(std::vector{Square("person", 300, 5, 9)}, {"person"}, {100, 100});
  EXPECT_EQ(cv::countNonZero(outside), 0);
}

}  // namespace
}  // namespace hullslam
