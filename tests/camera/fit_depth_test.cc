// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/fit_depth.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <type_traits>

#include "hullslam/geometry/rigid3.h"

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

// The plane z = 2 + 0.5 x in the frame of the colour camera, seen by a depth camera beside it.
TEST(DepthReprojection, GivesTheDepthsThatTheColourCameraSees) {
  PinholeCamera camera;
  camera.fx = camera.fy = 80.0;
  camera.cx = 64.0;
  camera.cy = 48.0;
  camera.k1 = 0.1;
  camera.width = 128;
  camera.height = 96;
  const std::array<double, 6> pose = {0.01, -0.02, 0.015, 0.03, -0.02, 0.04};
  const Rigid3 depth_from_colour(ExpSo3(Eigen::Map<const Eigen::Vector3d>(pose.data())),
                                 Eigen::Map<const Eigen::Vector3d>(pose.data() + 3));
  const auto image_from = [&](const Rigid3& camera_from_colour, int type) {
    const Eigen::Vector3d normal = camera_from_colour.rotation * Eigen::Vector3d(-0.5, 0.0, 1.0);
    cv::Mat image(camera.height, camera.width, type);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        const Eigen::Vector3d ray = camera.Unproject(camera.Undistort(Eigen::Vector2d(x, y)), 1.0);
        const double z = (2.0 + normal.dot(camera_from_colour.translation)) / normal.dot(ray);
        type == CV_32FC1 ? void(image.at<float>(y, x) = static_cast<float>(z))
                         : void(image.at<uint16_t>(y, x) = cv::saturate_cast<uint16_t>(1e3 * z));
      }
    }
    return image;
  };
  const cv::Rect inside(8, 8, 112, 80);
  for (const int type : {CV_16UC1, CV_32FC1}) {
    const cv::Mat truth = image_from(Rigid3(), type)(inside);
    const cv::Mat seen = image_from(depth_from_colour, type);
    const cv::Mat registered = DepthReprojection(camera, pose).Register(seen, 1000.0);
    const double unit = type == CV_16UC1 ? 1000.0 : 1.0;
    // Half a pixel of the depth image is 1.3 cm here.
    EXPECT_GT(cv::norm(seen(inside), truth, cv::NORM_L1) / inside.area(), 0.05 * unit);
    EXPECT_LT(cv::norm(registered(inside), truth, cv::NORM_L1) / inside.area(), 0.008 * unit);
    EXPECT_LT(cv::norm(registered(inside), truth, cv::NORM_INF), 0.03 * unit);
  }
}

TEST(DepthReprojection, UnknownDepthsStayUnknown) {
  PinholeCamera camera;
  camera.fx = camera.fy = 20.0;
  camera.cx = 8.0;
  camera.cy = 6.0;
  camera.width = 16;
  camera.height = 12;
  cv::Mat depth(12, 16, CV_32FC1, cv::Scalar(2.0));
  depth.at<float>(3, 3) = std::numeric_limits<float>::quiet_NaN();
  depth.at<float>(5, 5) = std::numeric_limits<float>::infinity();
  depth.at<float>(7, 7) = -1.0F;
  depth.at<float>(9, 9) = 0.0F;
  const cv::Mat registered = DepthReprojection(camera, {}).Register(depth, 1.0);
  EXPECT_EQ(cv::countNonZero(registered == 2.0F), 12 * 16 - 4);
  EXPECT_EQ(cv::countNonZero(registered == 0.0F), 4);
  // 0.2 m to the side are 2 px at 2 m, where the depth camera sees nothing of the last columns.
  const cv::Mat moved =
      DepthReprojection(camera, {0.0, 0.0, 0.0, 0.2, 0.0, 0.0}).Register(depth, 1.0);
  EXPECT_EQ(cv::countNonZero(moved.colRange(14, 16)), 0);
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
