// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/mask_outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;

cv::Mat Empty() { return {40, 60, CV_16SC1, cv::Scalar(-1)}; }

double Area(const std::vector<Vector2d>& polygon) {
  double twice = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(0.5 * twice);
}

TEST(FindOutlines, RectangleIsOutlinedHalfAPixelOutside) {
  cv::Mat image = Empty();
  image(cv::Rect(10, 5, 20, 8)) = 3;
  const auto outlines = FindOutlines(image, 10);
  ASSERT_EQ(outlines.size(), 1U);
  EXPECT_EQ(outlines[0].object, 3);
  EXPECT_EQ(outlines[0].area, 160);
  ASSERT_EQ(outlines[0].vertices.size(), 8U);  // the corners are cut by half a pixel
  EXPECT_NEAR(Area(outlines[0].vertices), 160.0 - 4 * 0.125, 1e-12);
  for (const Vector2d& vertex : outlines[0].vertices) {
    EXPECT_TRUE(vertex.x() == 9.5 || vertex.x() == 29.5 || vertex.y() == 4.5 || vertex.y() == 12.5)
        << vertex.transpose();
  }
}

TEST(FindOutlines, CircleIsNotBiased) {
  cv::Mat image = Empty();
  const Vector2d centre(29.3, 19.6);
  const double radius = 15.2;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<int16_t>(y, x) = (Vector2d(x, y) - centre).norm() < radius ? 0 : -1;
    }
  }
  const auto outlines = FindOutlines(image, 10);
  ASSERT_EQ(outlines.size(), 1U);
  double mean = 0.0;
  for (const Vector2d& vertex : outlines[0].vertices) {
    const double error = (vertex - centre).norm() - radius;
    EXPECT_LT(std::abs(error), 0.75);
    mean += error / static_cast<double>(outlines[0].vertices.size());
  }
  EXPECT_NEAR(mean, 0.0, 0.1);
}

TEST(FindOutlines, TakesTheLargestPartAndFillsHoles) {
  cv::Mat image = Empty();
  image(cv::Rect(0, 0, 30, 20)) = 1;
  image(cv::Rect(10, 5, 10, 10)) = 2;   // a hole in 1
  image(cv::Rect(40, 0, 20, 20)) = 1;   // a second, smaller part of object 1
  image(cv::Rect(30, 20, 12, 12)) = 5;  // touches object 1 at a corner only
  const auto outlines = FindOutlines(image, 100);
  ASSERT_EQ(outlines.size(), 3U);
  EXPECT_EQ(outlines[0].area, 500);
  EXPECT_NEAR(Area(outlines[0].vertices), 600.0 - 4 * 0.125, 1e-12);
  EXPECT_EQ(outlines[1].object, 2);
  EXPECT_EQ(outlines[2].area, 144);
}

TEST(FindOutlines, PixelsThatTouchByACornerAreTwoParts) {
  cv::Mat image = Empty();
  image(cv::Rect(0, 0, 5, 5)) = 1;
  image(cv::Rect(5, 5, 6, 6)) = 1;
  const auto outlines = FindOutlines(image, 1);
  ASSERT_EQ(outlines.size(), 1U);
  EXPECT_EQ(outlines[0].area, 36);
}

TEST(FindOutlines, LeavesOutSmallPartsAndChecksTheImageType) {
  cv::Mat image = Empty();
  image(cv::Rect(3, 3, 9, 11)) = 0;
  EXPECT_TRUE(FindOutlines(image, 100).empty());
  EXPECT_EQ(FindOutlines(image, 99).size(), 1U);
  EXPECT_TRUE(FindOutlines(Empty(), 1).empty());
  EXPECT_THROW(FindOutlines(cv::Mat(4, 4, CV_8UC1), 1), CheckError);
}

}  // namespace
}  // namespace hullslam::synthetic
