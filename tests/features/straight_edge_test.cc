// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/straight_edge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

namespace hullslam {
namespace {

constexpr int kSide = 21;
const cv::Point kCenter(kSide / 2, kSide / 2);

// An image whose grey levels are a function of the distance (px) from the centre.
template <typename Grey>
cv::Mat MakePatch(const Grey& grey) {
  cv::Mat image(kSide, kSide, CV_8UC1);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      image.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(grey(x - kCenter.x, y - kCenter.y));
    }
  }
  return image;
}

// A border of two grey levels through the centre, 2 px wide; `angle` is that of its normal.
cv::Mat MakeEdge(double angle) {
  return MakePatch([angle](double x, double y) {
    return 130.0 + 60.0 * std::clamp(std::cos(angle) * x + std::sin(angle) * y, -1.0, 1.0);
  });
}

cv::Mat MakeCorner() {
  return MakePatch([](double x, double y) { return x >= 0.0 && y >= 0.0 ? 170.0 : 90.0; });
}

TEST(StraightEdge, IsFoundInAllDirections) {
  for (int i = 0; i < 32; ++i) {
    EXPECT_TRUE(IsStraightEdge(MakeEdge(i * std::numbers::pi / 16.0), kCenter)) << i;
  }
}

TEST(StraightEdge, CornersDotsAndPlainPatchesAreNone) {
  EXPECT_FALSE(IsStraightEdge(MakeCorner(), kCenter));
  EXPECT_FALSE(IsStraightEdge(
      MakePatch([](double x, double y) { return x * x + y * y < 5.0 ? 200.0 : 90.0; }), kCenter));
  EXPECT_FALSE(IsStraightEdge(MakePatch([](double, double) { return 90.0; }), kCenter));
}

// The tensor of |y| b + x a is diagonal. It has 49 gradients a along x, and 42 gradients b along y,
// because there is none in the middle row.
TEST(StraightEdge, IsOneIfAnEigenvalueIsSixteenTimesTheOther) {
  const auto ramp = [](double a, double b) {
    return MakePatch([a, b](double x, double y) { return 127.0 + a * x + b * std::abs(y); });
  };
  EXPECT_TRUE(IsStraightEdge(ramp(8.0, 2.0), kCenter));   // 49 64 / (42 4) = 18.7
  EXPECT_FALSE(IsStraightEdge(ramp(7.0, 2.0), kCenter));  // 49 49 / (42 4) = 14.3
}

TEST(StraightEdge, DoesNotDependOnContrastNorOnTheDirectionOfTheImage) {
  for (int i = 0; i <= 6; ++i) {
    const cv::Mat image =
        MakePatch([i](double x, double y) { return 127.0 + 6.0 * x + i * std::abs(y); });
    const bool is_edge = IsStraightEdge(image, kCenter);
    EXPECT_EQ(is_edge, IsStraightEdge(255 - image, kCenter)) << i;
    EXPECT_EQ(is_edge, IsStraightEdge(image.t(), kCenter)) << i;
    EXPECT_EQ(is_edge, i < 2) << i;  // 49 36 / (42 i^2) = 42 / i^2
  }
}

}  // namespace
}  // namespace hullslam
