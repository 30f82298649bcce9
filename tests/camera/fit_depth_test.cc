// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/fit_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <type_traits>

namespace hullslam {
namespace {

// The depth (m) of a slanted plane at a place of an image, 0 to 1 along both sides.
double Plane(double x, double y) { return 1.0 / (0.5 - 0.2 * x + 0.1 * y); }

cv::Mat PlaneImage(const cv::Size& size, int type) {
  cv::Mat image(size, type);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double depth = Plane((x + 0.5) / size.width, (y + 0.5) / size.height);
      if (type == CV_16UC1) {
        image.at<uint16_t>(y, x) = static_cast<uint16_t>(std::lround(1000.0 * depth));
      } else {
        image.at<float>(y, x) = static_cast<float>(depth);
      }
    }
  }
  return image;
}

// The pixels at the rim lie outside of the centres of the small image.
TEST(FitDepth, PlanesStayPlanes) {
  const cv::Size small(64, 48);
  const cv::Size large(486, 363);
  const cv::Rect inside(4, 4, 478, 355);
  for (const int type : {CV_16UC1, CV_32FC1}) {
    const cv::Mat fitted = FitDepth(PlaneImage(small, type), large);
    const cv::Mat expected = PlaneImage(large, type);
    ASSERT_EQ(fitted.size(), large);
    ASSERT_EQ(fitted.type(), type);
    const double error = cv::norm(fitted(inside), expected(inside), cv::NORM_INF);
    EXPECT_LE(error, type == CV_16UC1 ? 2.0 : 1e-5) << "units";
  }
}

TEST(FitDepth, ForegroundAndBackgroundAreNotMixed) {
  cv::Mat depth(12, 16, CV_16UC1, cv::Scalar(3000));
  depth.colRange(8, 16).setTo(1000);
  const cv::Mat fitted = FitDepth(depth, {160, 120});
  EXPECT_EQ(cv::countNonZero(fitted == 3000), 160 * 120 / 2);
  EXPECT_EQ(cv::countNonZero(fitted == 1000), 160 * 120 / 2);
  EXPECT_EQ(fitted.at<uint16_t>(60, 79), 3000) << "the border stays in its column";
  EXPECT_EQ(fitted.at<uint16_t>(60, 80), 1000);
}

// The limit is 5 % from pixel to pixel: less is a slant, more is the border of a thing.
TEST(FitDepth, ASlantIsMixedUpToFivePercent) {
  const auto fit_step = [](uint16_t farther) {
    cv::Mat depth(12, 16, CV_16UC1, cv::Scalar(10000));
    depth.colRange(8, 16).setTo(farther);
    const cv::Mat fitted = FitDepth(depth, {160, 120});
    return 160 * 120 - cv::countNonZero(fitted == 10000) - cv::countNonZero(fitted == farther);
  };
  EXPECT_EQ(fit_step(10490), 10 * 120) << "the pixels between the centres of both columns";
  EXPECT_EQ(fit_step(10510), 0);
  EXPECT_EQ(fit_step(12000), 0);
}

TEST(FitDepth, UnknownStaysUnknownAndDoesNotSpread) {
  cv::Mat depth(12, 16, CV_32FC1, cv::Scalar(2.0F));
  depth.at<float>(5, 5) = 0.0F;
  depth.at<float>(5, 10) = std::numeric_limits<float>::quiet_NaN();
  const cv::Mat fitted = FitDepth(depth, {160, 120});
  EXPECT_EQ(cv::countNonZero(fitted == 0.0F), 100) << "the pixels that it covers";
  EXPECT_EQ(cv::countNonZero(fitted == 2.0F), 160 * 120 - 200);
}

TEST(FitDepth, ImagesOfTheSameSizeAreReturnedAsTheyAre) {
  const cv::Mat depth = PlaneImage({64, 48}, CV_16UC1);
  EXPECT_EQ(FitDepth(depth, {64, 48}).data, depth.data);
  EXPECT_TRUE(FitDepth(cv::Mat(), {64, 48}).empty());
  EXPECT_EQ(FitDepth(PlaneImage({128, 96}, CV_16UC1), {64, 48}).size(), cv::Size(64, 48));
}

TEST(FitDepth, ShapesAreComparedByTheRatioOfTheirSides) {
  EXPECT_TRUE(HaveSameShape({256, 192}, {1920, 1440}));
  EXPECT_TRUE(HaveSameShape({640, 480}, {1296, 968}));
  EXPECT_FALSE(HaveSameShape({640, 480}, {1280, 720}));
  EXPECT_FALSE(HaveSameShape({480, 640}, {640, 480}));
  EXPECT_FALSE(HaveSameShape({0, 0}, {640, 480}));
}

// A camera that measures disparities bf / z that are too large by an offset.
TEST(WithoutDisparityOffset, GivesTheDepthThatACameraWithoutOffsetMeasures) {
  constexpr double kOffset = 0.8;  // px
  constexpr double kBf = 40.0;     // m px
  for (const int type : {CV_16UC1, CV_32FC1}) {
    cv::Mat measured = PlaneImage({64, 48}, type);
    const cv::Mat truth = measured.clone();
    const double units = type == CV_16UC1 ? 1000.0 : 1.0;
    const auto shift = [&](auto& value) {
      value = cv::saturate_cast<std::remove_reference_t<decltype(value)>>(
          units * kBf / (kBf / (static_cast<double>(value) / units) + kOffset));
    };
    for (int y = 0; y < measured.rows; ++y) {
      for (int x = 0; x < measured.cols; ++x) {
        type == CV_16UC1 ? shift(measured.at<uint16_t>(y, x)) : shift(measured.at<float>(y, x));
      }
    }
    const cv::Mat corrected = WithoutDisparityOffset(measured, kOffset, kBf, 1000.0);
    EXPECT_LT(cv::norm(corrected, truth, cv::NORM_INF), type == CV_16UC1 ? 2.0 : 1e-5);
  }
}

TEST(WithoutDisparityOffset, UnknownAndImpossibleDepthsAreUnknown) {
  cv::Mat depth(1, 3, CV_32FC1);
  depth.at<float>(0, 0) = 0.0F;
  depth.at<float>(0, 1) = std::numeric_limits<float>::quiet_NaN();
  depth.at<float>(0, 2) = 100.0F;  // a disparity of 0.4 px, less than the offset
  const cv::Mat corrected = WithoutDisparityOffset(depth, 0.5, 40.0, 1000.0);
  EXPECT_EQ(cv::countNonZero(corrected), 0);
}

}  // namespace
}  // namespace hullslam
