// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/relative_gradient.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace hullslam {
namespace {

// Two vertical edges of the given heights, far from each other and from the borders.
cv::Mat TwoEdges(int first, int second) {
  cv::Mat grey(40, 60, CV_8UC1, cv::Scalar(0));
  grey.colRange(20, 60).setTo(first);
  grey.colRange(40, 60).setTo(first + second);
  return grey;
}

TEST(RelativeGradient, HasTheMeanOne) {
  const cv::Mat gradient = RelativeGradient(TwoEdges(10, 30));
  EXPECT_EQ(gradient.type(), CV_32FC1);
  EXPECT_NEAR(cv::mean(gradient)[0], 1.0, 1e-5);
  EXPECT_NEAR(gradient.at<float>(20, 40), 3.0f * gradient.at<float>(20, 20), 1e-4f);
  EXPECT_EQ(gradient.at<float>(20, 10), 0.0f);
  cv::Mat turned = RelativeGradient(TwoEdges(10, 30).t());
  EXPECT_LT(cv::norm(turned.t(), gradient, cv::NORM_INF), 1e-5) << "both directions count";
}

// Sobel's filter multiplies the height of an edge by 4, so those above 50 are limited.
TEST(RelativeGradient, StrongEdgesAreLimited) {
  const cv::Mat gradient = RelativeGradient(TwoEdges(60, 180));
  EXPECT_FLOAT_EQ(gradient.at<float>(20, 20), gradient.at<float>(20, 40));
  const cv::Mat below = RelativeGradient(TwoEdges(40, 180));
  EXPECT_NEAR(below.at<float>(20, 40), 1.25f * below.at<float>(20, 20), 1e-4f);
}

TEST(RelativeGradient, IsZeroWithoutEdges) {
  EXPECT_EQ(cv::countNonZero(RelativeGradient(cv::Mat(9, 9, CV_8UC1, cv::Scalar(7)))), 0);
}

}  // namespace
}  // namespace hullslam
