// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/pair_check.h"

#include <gtest/gtest.h>

#include "features/test_images.h"

namespace hullslam {
namespace {

// The image moved by a number of pixels to the left and down.
cv::Mat Move(const cv::Mat& image, int left, int down) {
  cv::Mat moved(image.size(), CV_8UC1, cv::Scalar(120));
  const cv::Rect from(left, 0, image.cols - left, image.rows - down);
  image(from).copyTo(moved(cv::Rect(0, down, from.width, from.height)));
  return moved;
}

std::string FaultOf(const cv::Mat& left, const cv::Mat& right) {
  PairCheck check;
  check.Add(left, right);
  return check.FindFault().value_or("");
}

TEST(PairCheck, AGoodPairHasNoFault) {
  const cv::Mat image = MakeCornerImage();
  EXPECT_EQ(FaultOf(image, Move(image, 20, 0)), "");
  EXPECT_EQ(FaultOf(image, Move(image, 20, 1)), "");
}

TEST(PairCheck, FaultsAreNamed) {
  const cv::Mat image = MakeCornerImage();
  EXPECT_NE(FaultOf(Move(image, 20, 0), image).find("swapped"), std::string::npos);
  EXPECT_NE(FaultOf(image, image).find("the same image"), std::string::npos);
  EXPECT_NE(FaultOf(image, Move(image, 20, 6)).find("6.0 px lower"), std::string::npos);
}

TEST(PairCheck, FewMatchesSayNothing) {
  const cv::Mat grey(480, 640, CV_8UC1, cv::Scalar(90));
  EXPECT_EQ(FaultOf(grey, grey), "");
}

}  // namespace
}  // namespace hullslam
