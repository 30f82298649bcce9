// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/patch_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace hullslam {
namespace {

const cv::Point kAt(40, 30);

// A smooth texture, whose columns and rows are moved.
cv::Mat Texture(double columns, double rows, double gain = 1.0, double offset = 0.0) {
  cv::Mat image(60, 80, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double u = x - columns;
      const double v = y - rows;
      const double value = 120.0 + 40.0 * std::sin(0.7 * u + 0.3 * v) +
                           25.0 * std::sin(0.5 * v - 0.2 * u) + 20.0 * std::cos(0.31 * u);
      image.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(gain * value + offset);
    }
  }
  return image;
}

TEST(PatchFit, FindsFractionsOfAPixelWithoutABias) {
  for (int i = -9; i <= 9; ++i) {
    const double moved = 0.21 * i;
    const auto fit = FitPatch(Texture(0.0, 0.0), kAt, Texture(moved, 0.0), kAt.x);
    ASSERT_TRUE(fit) << moved;
    EXPECT_NEAR(fit->column - kAt.x, moved, 0.02);
  }
}

TEST(PatchFit, BrightnessAndContrastDoNotMatter) {
  const auto fit = FitPatch(Texture(0.0, 0.0), kAt, Texture(1.4, 0.0, 0.7, 20.0), kAt.x);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->column - kAt.x, 1.4, 0.02);
}

// A smooth ramp about a bright spot: the farther the patch is shifted, the better it fits.
TEST(PatchFit, TheLastShiftIsNotTheBestOne) {
  const auto spot = [](double column) {
    cv::Mat image(60, 80, CV_8UC1);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        image.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(
            200.0 * std::exp(-(std::pow(x - column, 2) + std::pow(y - 30.0, 2)) / 60.0));
      }
    }
    return image;
  };
  const cv::Mat left = spot(40.0);
  EXPECT_TRUE(FitPatch(left, kAt, spot(44.2), kAt.x));
  EXPECT_TRUE(FitPatch(left, kAt, spot(35.8), kAt.x));
  EXPECT_FALSE(FitPatch(left, kAt, spot(45.8), kAt.x));
  EXPECT_FALSE(FitPatch(left, kAt, spot(34.2), kAt.x));
}

TEST(PatchFit, PatchesMustLieInTheImages) {
  const cv::Mat image = Texture(0.0, 0.0);
  EXPECT_TRUE(FitPatch(image, {40, 30}, image, 40));
  for (const cv::Point& at : {cv::Point(5, 30), cv::Point(76, 30), cv::Point(40, 4),
                              cv::Point(40, 57), cv::Point(-3, 30)}) {
    EXPECT_FALSE(FitPatch(image, at, image, at.x)) << at;
  }
  EXPECT_FALSE(FitPatch(image, {40, 30}, image, 2));
  EXPECT_FALSE(FitPatch(image, {40, 30}, image, 200));
}

TEST(PatchFit, APatchWithoutTextureHasNoColumn) {
  const cv::Mat grey(60, 80, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(FitPatch(grey, kAt, grey, kAt.x));
}

}  // namespace
}  // namespace hullslam
