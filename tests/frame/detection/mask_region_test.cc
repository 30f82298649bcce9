// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/mask_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "support/square_mask.h"

namespace hullslam {
namespace {

using Eigen::Vector2d;
using Outlines = std::vector<std::vector<Vector2d>>;

PinholeCamera SmallImage() {
  PinholeCamera camera;
  camera.width = 64;
  camera.height = 48;
  return camera;
}

std::vector<Vector2d> RandomTriangle(std::mt19937& random) {
  std::uniform_real_distribution<double> x(-20.0, 84.0);
  std::uniform_real_distribution<double> y(-20.0, 68.0);
  std::vector<Vector2d> triangle;
  for (int i = 0; i < 3; ++i) {
    triangle.emplace_back(x(random), y(random));
  }
  return triangle;
}

// The pixels of the image for which `holds` is true.
template <typename Holds>
int CountPixels(const Holds& holds) {
  int count = 0;
  for (int y = 0; y < SmallImage().height; ++y) {
    for (int x = 0; x < SmallImage().width; ++x) {
      count += holds(Vector2d(x, y)) ? 1 : 0;
    }
  }
  return count;
}

TEST(MaskRegion, AreasAreNumbersOfPixelsInTheImage) {
  std::mt19937 random(5);
  for (int i = 0; i < 50; ++i) {
    const Outlines a = {RandomTriangle(random), RandomTriangle(random)};  // the two may overlap
    const Outlines b = {RandomTriangle(random)};
    const MaskRegion region(a, SmallImage());
    const MaskRegion other(b, SmallImage());
    EXPECT_EQ(region.area(), CountPixels([&](const Vector2d& p) { return region.Contains(p); }));
    const int shared =
        CountPixels([&](const Vector2d& p) { return region.Contains(p) && other.Contains(p); });
    EXPECT_EQ(SharedArea(region, other), shared);
    EXPECT_EQ(SharedArea(other, region), shared);
    EXPECT_EQ(SharedArea(region, region), region.area());
    // Nothing is lost where the parts overlap.
    const MaskRegion first(std::span<const std::vector<Vector2d>>(a).first(1), SmallImage());
    const MaskRegion second(std::span<const std::vector<Vector2d>>(a).last(1), SmallImage());
    EXPECT_EQ(region.area(), first.area() + second.area() - SharedArea(first, second));
  }
}

TEST(MaskRegion, IsCutByTheImage) {
  const Outlines all = {{{-1e9, -1e9}, {1e9, -1e9}, {1e9, 1e9}, {-1e9, 1e9}}};
  const MaskRegion whole(all, SmallImage());
  EXPECT_EQ(whole.area(), 64 * 48);
  EXPECT_EQ(whole.box(), cv::Rect(0, 0, 64, 48));
  EXPECT_FALSE(whole.Contains({-1.0, 3.0}));
  EXPECT_FALSE(whole.Contains({3.0, 48.0}));
  const Outlines beside = {{{70.0, 1.0}, {80.0, 1.0}, {80.0, 9.0}}};
  const MaskRegion outside(beside, SmallImage());
  EXPECT_EQ(outside.area(), 0);
  EXPECT_TRUE(outside.box().empty());
  EXPECT_EQ(SharedArea(outside, whole), 0);
  EXPECT_FALSE(outside.Contains({75.0, 2.0}));
}

TEST(MaskRegion, APixelWithItsSurroundingsIsFartherInsideTheLargerTheMargin) {
  const Outlines square = {{{10.0, 10.0}, {40.0, 10.0}, {40.0, 40.0}, {10.0, 40.0}}};
  const MaskRegion region(square, SmallImage());
  int before = region.area();
  for (const double margin : {0.0, 2.0, 5.0, 10.0}) {
    const int inside =
        CountPixels([&](const Vector2d& p) { return region.ContainsAround(p, margin); });
    // The square without a border of this width.
    const int side = 31 - 2 * static_cast<int>(margin);
    EXPECT_EQ(inside, side * side) << margin;
    EXPECT_LE(inside, before);
    before = inside;
  }
  EXPECT_EQ(CountPixels([&](const Vector2d& p) { return region.ContainsAround(p, 16.0); }), 0);
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
