// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/depth_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

namespace hullslam {
namespace {

constexpr double kBf = 40.0;

RawKeypoint At(double x, double y) {
  RawKeypoint keypoint;
  keypoint.raw = Eigen::Vector2d(x, y).cast<float>();
  return keypoint;
}

// The disparity of a plane is linear in the image. It is given at the middle of a 160 x 120 px
// image with its slopes, px per px.
struct Plane {
  double disparity = 20.0;
  double by_x = 0.0;
  double by_y = 0.0;

  double DepthAt(double x, double y) const {
    return kBf / (disparity + by_x * (x - 80.0) + by_y * (y - 60.0));
  }
  cv::Mat Image() const {
    cv::Mat image(120, 160, CV_16UC1);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        image.at<uint16_t>(y, x) = static_cast<uint16_t>(std::lround(5000.0 * DepthAt(x, y)));
      }
    }
    return image;
  }
};

// A step of the disparity between the columns 79 and 80.
cv::Mat Step(double left, double right) {
  cv::Mat image = Plane{.disparity = left}.Image();
  Plane{.disparity = right}.Image().colRange(80, 160).copyTo(image.colRange(80, 160));
  return image;
}

bool IsKnown(const cv::Mat& depth, double x, double scale, const DepthOptions& options = {}) {
  return KeypointDepth(depth, At(x, 60.0), scale, kBf, options) > 0.0F;
}

// Every keypoint of a plane has a depth, however much the plane is slanted. The nearest pixel is up
// to half a pixel away; over many keypoints that is no error.
TEST(KeypointDepth, OfASlantedPlaneIsThatOfThePlane) {
  for (const Plane& plane : {Plane{20.0, 0.1, -0.04}, Plane{20.0, -0.08, 0.12}, Plane{12.0}}) {
    const cv::Mat depth = plane.Image();
    for (const double scale : {1.0, 1.728, 3.583}) {
      double sum = 0.0;
      int count = 0;
      for (double y = 20.0; y < 100.0; y += 3.7) {
        for (double x = 20.0; x < 140.0; x += 2.3) {
          const auto found = static_cast<double>(KeypointDepth(depth, At(x, y), scale, kBf, {}));
          ASSERT_GT(found, 0.0) << x << ", " << y;
          EXPECT_NEAR(kBf / found, kBf / plane.DepthAt(x, y), 0.11);
          sum += kBf / found - kBf / plane.DepthAt(x, y);
          ++count;
        }
      }
      EXPECT_NEAR(sum / count, 0.0, 0.005) << "px";
    }
  }
}

// A corner may be as far from the border that it shows as the circle of FAST reaches at its level.
TEST(KeypointDepth, IsUnknownWithinTheReachOfABorder) {
  const cv::Mat depth = Step(20.0, 15.0);
  EXPECT_TRUE(IsKnown(depth, 76.4, 1.0));
  EXPECT_FALSE(IsKnown(depth, 76.6, 1.0));
  EXPECT_FALSE(IsKnown(depth, 79.0, 1.0));
  EXPECT_FALSE(IsKnown(depth, 82.4, 1.0));
  EXPECT_TRUE(IsKnown(depth, 82.6, 1.0));
  EXPECT_TRUE(IsKnown(depth, 73.4, 2.0));
  EXPECT_FALSE(IsKnown(depth, 73.6, 2.0));
  // The same along the other axis.
  EXPECT_EQ(KeypointDepth(depth.t(), At(60.0, 77.0), 1.0, kBf, {}), 0.0F);
  EXPECT_GT(KeypointDepth(depth.t(), At(60.0, 76.0), 1.0, kBf, {}), 0.0F);
}

// The error of depth is no border. The mean of opposite points differs by half of a step.
TEST(KeypointDepth, ABendOfLessThanAThirdOfAPixelIsNoBorder) {
  EXPECT_TRUE(IsKnown(Step(20.0, 19.42), 78.0, 1.0));
  EXPECT_FALSE(IsKnown(Step(20.0, 19.38), 78.0, 1.0));
  EXPECT_TRUE(IsKnown(Step(19.42, 20.0), 78.0, 1.0));
  EXPECT_FALSE(IsKnown(Step(19.38, 20.0), 78.0, 1.0));
}

TEST(KeypointDepth, WhatIsUnknownIsNoBorder) {
  cv::Mat depth = Plane{}.Image();
  depth.colRange(80, 160).setTo(0);
  EXPECT_TRUE(IsKnown(depth, 78.0, 1.0));
  EXPECT_FALSE(IsKnown(depth, 80.0, 1.0));
  EXPECT_FALSE(IsKnown(depth, 170.0, 1.0)) << "outside the image";
  EXPECT_TRUE(IsKnown(Plane{}.Image(), 0.0, 1.0)) << "the circle leaves the image";
}

// ORB-SLAM2 takes the depth of the pixel.
TEST(KeypointDepth, BordersHaveADepthWithTheErrorModelOfOrbSlam2) {
  DepthOptions options;
  options.error.model = DepthErrorModel::kRightColumn;
  EXPECT_TRUE(IsKnown(Step(20.0, 15.0), 78.0, 1.0, options));
}

}  // namespace

}  // namespace hullslam
