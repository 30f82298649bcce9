// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/camera/depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(SampleDepth, ReadsTheNearestPixelOfAnIntegerImage) {
  cv::Mat depth(3, 4, CV_16UC1, cv::Scalar(0));
  depth.at<uint16_t>(1, 2) = 7500;
  EXPECT_FLOAT_EQ(SampleDepth(depth, {2.0f, 1.0f}, 5000.0), 1.5f);
  EXPECT_FLOAT_EQ(SampleDepth(depth, {1.6f, 1.4f}, 5000.0), 1.5f);
  EXPECT_FLOAT_EQ(SampleDepth(depth, {2.4f, 0.6f}, 5000.0), 1.5f);
  EXPECT_FLOAT_EQ(SampleDepth(depth, {2.0f, 1.0f}, 1000.0), 7.5f);
  EXPECT_EQ(SampleDepth(depth, {1.4f, 1.0f}, 5000.0), 0.0f);
}

TEST(SampleDepth, KeepsTheFullRangeOfAnIntegerImage) {
  const cv::Mat depth(2, 2, CV_16UC1, cv::Scalar(65535));
  EXPECT_FLOAT_EQ(SampleDepth(depth, {1.0f, 1.0f}, 5000.0), 13.107f);
}

TEST(SampleDepth, ReadsMetresAndTreatsInvalidValuesAsUnknown) {
  cv::Mat depth(1, 5, CV_32FC1);
  const float values[] = {2.25f, kNan, kInfinity, -1.0f, 0.0f};
  for (int i = 0; i < 5; ++i) {
    depth.at<float>(0, i) = values[i];
  }
  EXPECT_EQ(SampleDepth(depth, {0.0f, 0.0f}, 5000.0), 2.25f);
  for (int i = 1; i < 5; ++i) {
    EXPECT_EQ(SampleDepth(depth, {static_cast<float>(i), 0.0f}, 5000.0), 0.0f) << values[i];
  }
}

TEST(SampleDepth, IsUnknownOutsideTheImage) {
  const cv::Mat depth(3, 4, CV_16UC1, cv::Scalar(5000));
  EXPECT_EQ(SampleDepth(depth, {3.4f, 2.4f}, 5000.0), 1.0f);
  EXPECT_EQ(SampleDepth(depth, {-0.4f, -0.4f}, 5000.0), 1.0f);
  EXPECT_EQ(SampleDepth(depth, {3.6f, 1.0f}, 5000.0), 0.0f);
  EXPECT_EQ(SampleDepth(depth, {1.0f, 2.6f}, 5000.0), 0.0f);
  EXPECT_EQ(SampleDepth(depth, {-0.6f, 1.0f}, 5000.0), 0.0f);
  EXPECT_EQ(SampleDepth(depth, {1.0f, -0.6f}, 5000.0), 0.0f);
  EXPECT_EQ(SampleDepth(depth, {kNan, 1.0f}, 5000.0), 0.0f);
  EXPECT_EQ(SampleDepth(depth, {1e30f, 1.0f}, 5000.0), 0.0f);
}

TEST(SampleDepth, RejectsOtherImageTypes) {
  EXPECT_THROW(SampleDepth(cv::Mat(3, 4, CV_8UC1, cv::Scalar(5)), {1.0f, 1.0f}, 5000.0),
               CheckError);
  EXPECT_THROW(SampleDepth(cv::Mat(3, 4, CV_64FC1, cv::Scalar(5)), {1.0f, 1.0f}, 5000.0),
               CheckError);
}

TEST(DepthOptions, BindsTheKeysOfOrbSlam2) {
  DepthOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("DepthMapFactor", "1000", "test");
  table.Set("ThDepth", "35.5", "test");
  EXPECT_EQ(options.units_per_metre, 1000.0);
  EXPECT_EQ(options.close_baselines, 35.5);
  for (const char* value : {"0", "-1", "inf", "nan", "x"}) {
    EXPECT_THROW(table.Set("DepthMapFactor", value, "test"), InputError) << value;
    EXPECT_THROW(table.Set("ThDepth", value, "test"), InputError) << value;
  }
}

TEST(DepthErrorOptions, AreBoundWithTheOtherOptionsOfDepth) {
  DepthOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("depth.disparity_sigma", "0.25", "test");
  table.Set("depth.pixel_sigma", "0.5", "test");
  EXPECT_EQ(options.error.disparity_sigma, 0.25);
  EXPECT_EQ(options.error.pixel_sigma, 0.5);
  for (const char* value : {"0", "-1", "nan", "x"}) {
    EXPECT_THROW(table.Set("depth.disparity_sigma", value, "test"), InputError) << value;
    EXPECT_THROW(table.Set("depth.pixel_sigma", value, "test"), InputError) << value;
  }
}

}  // namespace
}  // namespace hullslam
