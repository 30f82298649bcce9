// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace hullslam::synthetic {
namespace {

RenderedFrame FlatFrame(float depth, float cosine) {
  const cv::Size size(320, 240);
  return {.colour = cv::Mat(size, CV_32FC3, cv::Scalar(60.4, 120.0, 200.0)),
          .depth = cv::Mat(size, CV_32FC1, cv::Scalar(depth)),
          .instance = cv::Mat(size, CV_16SC1, cv::Scalar(-1)),
          .cosine = cv::Mat(size, CV_32FC1, cv::Scalar(cosine))};
}

// Standard deviation of the known depths, in metres.
double DepthError(float z) {
  const cv::Mat depth = Sensor({}, 1).Depth(FlatFrame(z, 1.0F), 0);
  double squares = 0.0;
  int count = 0;
  for (int i = 0; i < static_cast<int>(depth.total()); ++i) {
    const uint16_t units = depth.at<uint16_t>(i / depth.cols, i % depth.cols);
    if (units != 0) {
      squares += std::pow(units / 5000.0 - z, 2.0);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(Sensor, WithoutNoiseDepthIsOnlyRounded) {
  const Sensor sensor({.noise = false}, 1);
  const cv::Mat depth = sensor.Depth(FlatFrame(1.23456F, 1.0F), 0);
  EXPECT_EQ(depth.type(), CV_16UC1);
  EXPECT_EQ(cv::norm(depth, cv::Mat(depth.size(), CV_16UC1, cv::Scalar(6173)), cv::NORM_INF), 0.0);
  const cv::Mat colour = sensor.Colour(FlatFrame(1.0F, 1.0F), 0);
  EXPECT_EQ(colour.at<cv::Vec3b>(7, 9), cv::Vec3b(60, 120, 200));
}

// Range and noise are those along the ray; the image has the depth along z.
TEST(Sensor, DepthOfAFisheyeIsAlongZ) {
  RenderedFrame frame = FlatFrame(2.0F, 1.0F);
  frame.axial = cv::Mat(frame.depth.size(), CV_32FC1, cv::Scalar(0.2F));
  frame.axial.at<float>(5, 6) = -0.3F;  // behind the plane of the camera
  const cv::Mat depth = Sensor({.noise = false}, 1).Depth(frame, 0);
  EXPECT_EQ(depth.at<uint16_t>(7, 9), 2000);
  EXPECT_EQ(depth.at<uint16_t>(5, 6), 0);
  EXPECT_GT(cv::countNonZero(Sensor({}, 1).Depth(frame, 0)), 70000);
}

TEST(Sensor, DepthOutOfRangeOrGrazingIsUnknown) {
  for (const bool noise : {false, true}) {
    const Sensor sensor({.noise = noise}, 1);
    EXPECT_EQ(cv::countNonZero(sensor.Depth(FlatFrame(0.45F, 1.0F), 0)), 0);
    EXPECT_EQ(cv::countNonZero(sensor.Depth(FlatFrame(8.6F, 1.0F), 0)), 0);
  }
  const Sensor sensor({}, 1);
  EXPECT_EQ(cv::countNonZero(sensor.Depth(FlatFrame(2.0F, 0.09F), 0)), 0);
  EXPECT_EQ(cv::countNonZero(sensor.Depth(FlatFrame(2.0F, 0.5F), 0)), 320 * 240);
}

// The usual formula for the Kinect (Nguyen et al. 2012): 0.0012 + 0.0019 (z - 0.4)^2 metres.
TEST(Sensor, DepthErrorIsAboutThatOfAKinect) {
  for (const float z : {1.0F, 1.5F, 2.0F, 3.0F, 4.0F}) {
    const double sigma = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    EXPECT_GT(DepthError(z), 0.6 * sigma) << z;
    EXPECT_LT(DepthError(z), 1.5 * sigma) << z;
  }
}

TEST(Sensor, DepthOfIclNuimIsRoundedDisparityWithSmallNoise) {
  const Sensor sensor({.model = DepthModel::kIclNuim, .min_depth = 0.1, .max_depth = 13.0}, 1);
  for (const float z : {0.6F, 2.0F, 4.0F}) {
    const cv::Mat depth = sensor.Depth(FlatFrame(z, 0.05F), 0);
    EXPECT_EQ(cv::countNonZero(depth), 320 * 240) << "known also at a grazing angle";
    cv::Mat metres;
    depth.convertTo(metres, CV_64F, 1.0 / 5000.0);
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(metres, mean, deviation);
    const double step = z * z / 351.3;
    EXPECT_NEAR(mean[0], z, 0.55 * step);
    EXPECT_LT(deviation[0], 0.6 * step);
  }
  EXPECT_EQ(cv::countNonZero(sensor.Depth(FlatFrame(13.5F, 1.0F), 0)), 0);
}

// Beside an edge, some pixels take the depth of the other side or one in between.
TEST(Sensor, DepthEdgesOfIclNuimAreBlurred) {
  RenderedFrame frame = FlatFrame(1.0F, 1.0F);
  frame.depth.colRange(160, 320) = 3.0F;
  const Sensor sensor({.model = DepthModel::kIclNuim, .min_depth = 0.1, .max_depth = 13.0}, 1);
  const cv::Mat depth = sensor.Depth(frame, 0);
  int between = 0;
  for (int y = 0; y < depth.rows; ++y) {
    for (const int x : {158, 159, 160, 161}) {
      const double z = depth.at<uint16_t>(y, x) / 5000.0;
      between += z > 1.1 && z < 2.8 ? 1 : 0;
    }
    EXPECT_NEAR(depth.at<uint16_t>(y, 150) / 5000.0, 1.0, 0.01);
    EXPECT_NEAR(depth.at<uint16_t>(y, 170) / 5000.0, 3.0, 0.08);
  }
  EXPECT_GT(between, depth.rows / 4);
  EXPECT_EQ(cv::norm(depth, sensor.Depth(frame, 0), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(depth, sensor.Depth(frame, 1), cv::NORM_INF), 0.0);
}

TEST(Sensor, BayerFilterKeepsAPlainColour) {
  const cv::Mat colour =
      Sensor({.bayer = true, .noise = false}, 1).Colour(FlatFrame(1.0F, 1.0F), 0);
  EXPECT_EQ(colour.at<cv::Vec3b>(7, 9), cv::Vec3b(60, 120, 200));
  EXPECT_EQ(colour.at<cv::Vec3b>(100, 100), cv::Vec3b(60, 120, 200));
}

// Mean product of the noise of neighbours, divided by its variance, in the green channel.
double NoiseCorrelation(const Sensor::Options& options) {
  const cv::Mat colour = Sensor(options, 1).Colour(FlatFrame(1.0F, 1.0F), 0);
  double product = 0.0;
  double variance = 0.0;
  for (int y = 100; y < 140; ++y) {
    for (int x = 140; x < 180; ++x) {
      const double here = colour.at<cv::Vec3b>(y, x)[1] - 120.0;
      product += here * (colour.at<cv::Vec3b>(y, x + 1)[1] - 120.0);
      variance += here * here;
    }
  }
  return product / variance;
}

TEST(Sensor, BayerFilterMakesTheNoiseOfNeighboursAlike) {
  EXPECT_LT(NoiseCorrelation({}), 0.1);
  EXPECT_GT(NoiseCorrelation({.bayer = true}), 0.3);
}

TEST(Sensor, LensBlurSoftensEdgesAndKeepsTheirPlace) {
  RenderedFrame frame = FlatFrame(1.0F, 1.0F);
  frame.colour.colRange(160, 320) = cv::Scalar(160.4, 20.0, 0.0);
  const cv::Mat sharp = Sensor({.noise = false}, 1).Colour(frame, 0);
  const cv::Mat soft = Sensor({.lens_blur = 0.5, .noise = false}, 1).Colour(frame, 0);
  const auto blue = [](const cv::Mat& image, int x) { return image.at<cv::Vec3b>(50, x)[0]; };
  EXPECT_EQ(blue(sharp, 159), 60);
  EXPECT_GT(blue(soft, 159), 65);
  EXPECT_LT(blue(soft, 160), 155);
  EXPECT_NEAR(blue(soft, 159) + blue(soft, 160), 220, 1);
}

TEST(Sensor, DepthErrorGrowsWithTheSquareOfDepth) {
  // Half a step of noise plus rounding: 0.5 to 0.75 steps of 2.87e-3 z^2.
  for (const float z : {1.0F, 2.0F, 4.0F}) {
    const double steps = DepthError(z) / (2.87e-3 * z * z);
    EXPECT_GT(steps, 0.4) << z;
    EXPECT_LT(steps, 0.8) << z;
  }
}

TEST(Sensor, NearSurfacesCastAShadowToTheLeft) {
  RenderedFrame frame = FlatFrame(3.0F, 1.0F);
  frame.depth(cv::Rect(150, 100, 60, 60)) = 1.0;
  const cv::Mat depth = Sensor({}, 1).Depth(frame, 0);
  // 535 px * 7.5 cm * (1 / 1 m - 1 / 3 m) = 26.8 px
  EXPECT_EQ(cv::countNonZero(depth(cv::Rect(125, 105, 24, 50))), 0);
  EXPECT_EQ(cv::countNonZero(depth(cv::Rect(90, 105, 30, 50))), 30 * 50);
  EXPECT_EQ(cv::countNonZero(depth(cv::Rect(215, 105, 30, 50))), 30 * 50);
}

TEST(Sensor, ColourNoiseIsUnbiasedAndSmall) {
  const RenderedFrame frame = FlatFrame(2.0F, 1.0F);
  const cv::Mat image = Sensor({}, 1).Colour(frame, 0);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image(cv::Rect(150, 110, 20, 20)), mean, deviation);
  EXPECT_NEAR(mean[1], 120.0, 0.6);
  EXPECT_NEAR(deviation[1], std::sqrt(0.9 + 0.009 * 120.0), 0.25);
  EXPECT_GT(deviation[2], deviation[0]);
  EXPECT_LT(image.at<cv::Vec3b>(2, 2)[1], 115);  // the corners are darker
}

TEST(Sensor, NoiseDependsOnlyOnSeedAndFrame) {
  const RenderedFrame frame = FlatFrame(2.0F, 1.0F);
  const Sensor one({}, 1);
  EXPECT_EQ(cv::norm(one.Colour(frame, 3), Sensor({}, 1).Colour(frame, 3), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(one.Colour(frame, 3), one.Colour(frame, 4), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(one.Depth(frame, 3), Sensor({}, 2).Depth(frame, 3), cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(one.Depth(frame, 3), one.Depth(frame, 3), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace hullslam::synthetic
