// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/mask_outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

namespace hullslam {
namespace {

using Eigen::Vector2d;
using Outline = std::vector<Vector2d>;

double SignedArea(const Outline& outline) {
  double twice = 0.0;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vector2d& next = outline[(i + 1) % outline.size()];
    twice += outline[i].x() * next.y() - outline[i].y() * next.x();
  }
  return twice / 2.0;
}

// A mask of the pixels whose centres are inside an ellipse.
cv::Mat DrawEllipse(const Vector2d& center, double a, double b, double turn) {
  cv::Mat mask(240, 320, CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const Vector2d d = Vector2d(x, y) - center;
      const double u = (std::cos(turn) * d.x() + std::sin(turn) * d.y()) / a;
      const double v = (std::cos(turn) * d.y() - std::sin(turn) * d.x()) / b;
      mask.at<uint8_t>(y, x) = u * u + v * v <= 1.0 ? 255 : 0;
    }
  }
  return mask;
}

TEST(MaskOutline, RectanglesHaveStraightSidesBetweenPixels) {
  cv::Mat mask(20, 30, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(5, 3, 10, 4)).setTo(1);
  const auto outlines = FindMaskOutlines(mask);
  ASSERT_EQ(outlines.size(), 1U);
  ASSERT_EQ(outlines[0].size(), 8U);  // the corners are cut off between the middles of edges
  Vector2d low(1e9, 1e9);
  Vector2d high(-1e9, -1e9);
  for (const Vector2d& point : outlines[0]) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  EXPECT_EQ(low, Vector2d(4.5, 2.5));
  EXPECT_EQ(high, Vector2d(14.5, 6.5));
  EXPECT_DOUBLE_EQ(std::abs(SignedArea(outlines[0])), 40.0 - 4.0 / 8.0);
}

TEST(MaskOutline, MasksReachTheBorder) {
  const cv::Mat mask(4, 6, CV_8UC1, cv::Scalar(1));
  const auto outlines = FindMaskOutlines(mask);
  ASSERT_EQ(outlines.size(), 1U);
  EXPECT_DOUBLE_EQ(std::abs(SignedArea(outlines[0])), 24.0 - 0.5);
  for (const Vector2d& point : outlines[0]) {
    EXPECT_TRUE(point.x() >= -0.5 && point.y() >= -0.5 && point.x() <= 5.5 && point.y() <= 3.5);
  }
}

TEST(MaskOutline, SinglePixelIsADiamond) {
  cv::Mat mask(5, 5, CV_8UC1, cv::Scalar(0));
  mask.at<uint8_t>(2, 3) = 1;
  const auto outlines = FindMaskOutlines(mask);
  ASSERT_EQ(outlines.size(), 1U);
  EXPECT_DOUBLE_EQ(std::abs(SignedArea(outlines[0])), 0.5);
}

TEST(MaskOutline, HolesAreFilledAndPartsAreSeparate) {
  cv::Mat mask(40, 40, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(2, 2, 10, 10)).setTo(1);
  mask(cv::Rect(5, 5, 3, 3)).setTo(0);
  mask(cv::Rect(20, 20, 5, 5)).setTo(1);
  const auto outlines = FindMaskOutlines(mask);
  ASSERT_EQ(outlines.size(), 2U);
  EXPECT_DOUBLE_EQ(std::abs(SignedArea(outlines[0])) + std::abs(SignedArea(outlines[1])),
                   99.5 + 24.5);
  EXPECT_TRUE(FindMaskOutlines(cv::Mat::zeros(5, 5, CV_8UC1)).empty());
}

// Hulls and quadrics need outlines without bias. An outline through the centres of the outermost
// pixels would be 0.5 px too small in every direction; an outline along the edges of pixels would
// be too large in slanted directions.
TEST(MaskOutline, EllipsesKeepTheirSizeInEveryDirection) {
  constexpr double kA = 70.3;
  constexpr double kB = 40.7;
  for (const double turn : {0.0, 0.4, 1.1}) {
    const Vector2d center(160.2, 119.7);
    const auto outlines = FindMaskOutlines(DrawEllipse(center, kA, kB, turn));
    ASSERT_EQ(outlines.size(), 1U);
    EXPECT_NEAR(std::abs(SignedArea(outlines[0])) / (std::numbers::pi * kA * kB), 1.0, 0.001);
    double sum = 0.0;
    for (const Vector2d& point : outlines[0]) {
      const Vector2d d = point - center;
      const Vector2d u(std::cos(turn), std::sin(turn));
      const double radius = std::hypot(u.dot(d) / kA, (u.x() * d.y() - u.y() * d.x()) / kB);
      EXPECT_NEAR(radius, 1.0, 0.75 / kB);
      sum += (radius - 1.0) * kB;
    }
    EXPECT_NEAR(sum / static_cast<double>(outlines[0].size()), 0.0, 0.1);
  }
}

}  // namespace
}  // namespace hullslam
