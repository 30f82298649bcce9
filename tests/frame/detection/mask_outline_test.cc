// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/mask_outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "geometry/polygon.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

using Outlines = std::vector<std::vector<Eigen::Vector2d>>;

Outlines SquareAt(double side, double x) {
  return {{{x, 0.0}, {x + side, 0.0}, {x + side, side}, {x, side}}};
}

TEST(SortOutlines, OutlinesAreSortedByAreaWhateverTheirDirection) {
  const auto large = SquareAt(4.0, 0.0)[0];
  const auto middle = SquareAt(2.0, 10.0)[0];
  const auto tie = SquareAt(2.0, 20.0)[0];
  const auto small = SquareAt(0.9, 30.0)[0];
  Outlines outlines = {middle, small, {large.rbegin(), large.rend()}, tie};
  SortByArea(outlines);
  EXPECT_EQ(outlines, (Outlines{{large.rbegin(), large.rend()}, middle, tie}));
  EXPECT_LT(SignedArea(outlines[0]), 0.0);
}

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

// The outlines by OpenCV, on a lattice with twice the resolution whose points are the centres of
// pixels, the middles of edges and the corners.
std::vector<Outline> OutlinesByOpencv(const cv::Mat& mask) {
  cv::Mat padded;
  cv::copyMakeBorder(mask, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat lattice = cv::Mat::zeros(2 * padded.rows, 2 * padded.cols, CV_8UC1);
  for (int y = 0; y + 1 < lattice.rows; ++y) {
    for (int x = 0; x + 1 < lattice.cols; ++x) {
      int count = 0;
      for (const int py : {y / 2, (y + 1) / 2}) {
        for (const int px : {x / 2, (x + 1) / 2}) {
          count += padded.at<uint8_t>(py, px) != 0 ? 1 : 0;
        }
      }
      lattice.at<uint8_t>(y, x) = count >= 2 ? 1 : 0;
    }
  }
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(lattice, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  std::vector<Outline> outlines;
  for (const std::vector<cv::Point>& contour : contours) {
    Outline& outline = outlines.emplace_back();
    for (const cv::Point& point : contour) {
      outline.emplace_back(0.5 * point.x - 1.0, 0.5 * point.y - 1.0);
    }
  }
  return outlines;
}

// Dense ones have parts in the holes of other parts.
TEST(MaskOutline, OutlinesOfAnyMaskAreThoseOfOpencv) {
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    cv::Mat mask(1 + i % 23, 1 + i % 37, CV_8UC1);
    const unsigned inside = 1 + i % 9;  // of ten
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) {
        mask.at<uint8_t>(y, x) = random() % 10 < inside ? 255 : 0;
      }
    }
    ASSERT_EQ(FindMaskOutlines(mask), OutlinesByOpencv(mask)) << i << "\n" << mask;
  }
}

TEST(MaskOutline, APartInAHoleIsNoOutlineHoweverDeep) {
  cv::Mat mask(60, 60, CV_8UC1, cv::Scalar(0));
  for (int i = 0; i < 12; ++i) {
    cv::rectangle(mask, {2 * i, 2 * i, 60 - 4 * i, 60 - 4 * i}, cv::Scalar(i % 2 == 0 ? 255 : 0),
                  cv::FILLED);
  }
  EXPECT_EQ(FindMaskOutlines(mask).size(), 1U);
}

TEST(LabelOutlines, EachNumberHasTheOutlinesOfItsPixels) {
  std::mt19937 random(3);
  for (const int type : {CV_8UC1, CV_16UC1, CV_32SC1}) {
    for (const int block : {1, 3}) {
      cv::Mat labels(31, 40, type, cv::Scalar(0));
      for (int y = 0; y < labels.rows; y += block) {
        for (int x = 0; x < labels.cols; x += block) {
          const cv::Rect all(0, 0, labels.cols, labels.rows);
          labels(cv::Rect(x, y, block, block) & all) =
              cv::Scalar(static_cast<double>(random() % 4));
        }
      }
      const auto found = FindLabelOutlines(labels);
      EXPECT_EQ(found.size(), 3U) << "0 is no number";
      for (const auto& [number, outlines] : found) {
        EXPECT_EQ(outlines, OutlinesByOpencv(labels == number)) << number;
      }
    }
  }
  EXPECT_THROW(FindLabelOutlines(cv::Mat::zeros(3, 3, CV_32FC1)), CheckError);
}

TEST(LabelOutlines, NumbersMayBeLargeAndNegative) {
  cv::Mat labels(8, 8, CV_32SC1, cv::Scalar(0));
  labels(cv::Rect(2, 3, 4, 2)) = cv::Scalar(1'000'000);
  labels(cv::Rect(0, 0, 1, 1)) = cv::Scalar(-7);
  const auto found = FindLabelOutlines(labels);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found.at(1'000'000), OutlinesByOpencv(labels == 1'000'000));
  EXPECT_EQ(found.at(-7), OutlinesByOpencv(labels == -7));
}

// The pixels of each number are all over the image. Looking for each number in its box would take
// an hour.
TEST(LabelOutlines, ManyScatteredNumbersAreFoundInOnePass) {
  cv::Mat labels(480, 640, CV_16UC1);
  cv::RNG(3).fill(labels, cv::RNG::UNIFORM, 0, 65536);
  const auto found = FindLabelOutlines(labels);
  EXPECT_GT(found.size(), 60'000U);
  double area = 0.0;
  for (const auto& [number, outlines] : found) {
    for (const Outline& outline : outlines) {
      area += std::abs(SignedArea(outline));
    }
  }
  EXPECT_NEAR(area, 0.5 * 640 * 480, 100.0) << "nearly all are single pixels";
}

}  // namespace

}  // namespace hullslam
