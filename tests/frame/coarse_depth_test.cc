// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/coarse_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "features/test_images.h"

namespace hullslam {
namespace {

// A plane parallel to the images: all columns move by the same number of pixels.
TEST(CoarseDepth, FindsAPlane) {
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5, .bf = 50.0};
  const cv::Mat left = MakeCornerImage();
  const int disparity = 20;
  cv::Mat right(left.size(), CV_8UC1, cv::Scalar(120));
  left.colRange(disparity, left.cols).copyTo(right.colRange(0, left.cols - disparity));
  const cv::Mat depth = CoarseDepth(left, right, camera);
  ASSERT_EQ(depth.size(), left.size());
  ASSERT_EQ(depth.type(), CV_32FC1);
  int known = 0;
  int right_ones = 0;
  for (const float z : cv::Mat_<float>(depth)) {
    known += z > 0.0F ? 1 : 0;
    right_ones += std::abs(z - 2.5F) < 0.05F ? 1 : 0;
  }
  EXPECT_GT(known, 640 * 480 / 2);
  EXPECT_GT(right_ones, known * 95 / 100);
}

TEST(CoarseDepth, ImagesOfDifferentThingsHaveLittleDepth) {
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5, .bf = 50.0};
  const cv::Mat depth = CoarseDepth(MakeCornerImage(), MakeCornerImage(640, 480, 9), camera);
  EXPECT_LT(cv::countNonZero(depth), 640 * 480 / 3);
}

}  // namespace
}  // namespace hullslam
