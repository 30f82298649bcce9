// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/coarse_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "features/test_images.h"

namespace hullslam {
namespace {

// A plane parallel to the images: all columns move by the same number of pixels.
TEST(CoarseDepth, FindsAPlane) {
  SerialRunner runner;
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5, .bf = 50.0};
  const cv::Mat left = MakeCornerImage();
  const int disparity = 20;
  cv::Mat right(left.size(), CV_8UC1, cv::Scalar(120));
  left.colRange(disparity, left.cols).copyTo(right.colRange(0, left.cols - disparity));
  const cv::Mat depth =
      CoarseDepth(left, right, camera, {cv::Rect({0, 0}, left.size()), {}}, runner);
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

// The pair has far depths, as its keypoints say, so few disparities are tried. Inside the region
// the depths are those of the whole image, and columns at its left side are not lost.
TEST(CoarseDepth, OnlyTheRegionIsSearched) {
  SerialRunner runner;
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5, .bf = 50.0};
  const cv::Mat left = MakeCornerImage();
  const int disparity = 20;
  cv::Mat right(left.size(), CV_8UC1, cv::Scalar(120));
  left.colRange(disparity, left.cols).copyTo(right.colRange(0, left.cols - disparity));
  const cv::Rect region(161, 101, 200, 150);
  const std::vector<float> disparities(100, 20.0F);
  const cv::Mat depth = CoarseDepth(left, right, camera, {region, disparities}, runner);
  const int known = cv::countNonZero(depth(region));
  EXPECT_GT(known, region.area() * 8 / 10);
  EXPECT_EQ(cv::countNonZero(depth), known) << "something is known outside of the region";
  EXPECT_GT(cv::countNonZero(abs(depth(region) - 2.5) < 0.05), known * 95 / 100);
  const cv::Mat at_side = CoarseDepth(left, right, camera, {cv::Rect(0, 100, 80, 150), {}}, runner);
  const cv::Mat near =
      CoarseDepth(left, right, camera, {cv::Rect(0, 100, 80, 150), disparities}, runner);
  EXPECT_GT(cv::countNonZero(near), cv::countNonZero(at_side));
  EXPECT_EQ(cv::countNonZero(CoarseDepth(left, right, camera, {cv::Rect(), disparities}, runner)),
            0);
}

// The keypoints have disparities of 60 px, the plane one of 70 px.
TEST(CoarseDepth, FindsWhatIsALittleNearerThanTheKeypoints) {
  SerialRunner runner;
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5, .bf = 50.0};
  const cv::Mat left = MakeCornerImage();
  const int disparity = 70;
  cv::Mat right(left.size(), CV_8UC1, cv::Scalar(120));
  left.colRange(disparity, left.cols).copyTo(right.colRange(0, left.cols - disparity));
  const std::vector<float> disparities(100, 60.0F);
  const cv::Rect region(200, 100, 300, 250);
  const cv::Mat depth = CoarseDepth(left, right, camera, {region, disparities}, runner);
  const double metres = camera.bf / disparity;
  EXPECT_GT(cv::countNonZero(abs(depth(region) - metres) < 0.02), region.area() * 8 / 10);
}

// The image is searched in two bands. The first rows of the lower one have no texture of their own,
// so their depth follows from what the rows above them show.
TEST(CoarseDepth, TheLowerBandBeginsWithWhatTheRowsAboveItShow) {
  SerialRunner runner;
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5, .bf = 50.0};
  cv::Mat left = MakeCornerImage();
  const cv::Range blank(left.rows / 2, left.rows / 2 + 8);
  left.rowRange(blank).setTo(120);
  const int disparity = 20;
  cv::Mat right(left.size(), CV_8UC1, cv::Scalar(120));
  left.colRange(disparity, left.cols).copyTo(right.colRange(0, left.cols - disparity));
  const cv::Mat depth =
      CoarseDepth(left, right, camera, {cv::Rect({0, 0}, left.size()), {}}, runner);
  const cv::Mat seen = depth(blank, cv::Range(200, left.cols));
  EXPECT_GT(cv::countNonZero(abs(seen - 2.5) < 0.05), static_cast<int>(seen.total()) * 8 / 10);
}

TEST(CoarseDepth, ImagesOfDifferentThingsHaveLittleDepth) {
  SerialRunner runner;
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5, .bf = 50.0};
  const cv::Mat depth = CoarseDepth(MakeCornerImage(), MakeCornerImage(640, 480, 9), camera,
                                    {cv::Rect(0, 0, 640, 480), {}}, runner);
  EXPECT_LT(cv::countNonZero(depth), 640 * 480 / 3);
}

}  // namespace
}  // namespace hullslam
