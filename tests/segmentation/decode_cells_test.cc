// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "segmentation/network_layout.h"

namespace hullslam {
namespace {

NetworkLayout CellLayout() {
  return {.input = {64, 32}, .class_count = 2, .coefficient_count = 1, .heads = {0}};
}

// A map of one stride, 16 px, in which no cell finds anything.
cv::Mat EmptyMap() {
  const std::array<int, 4> shape = {1, kBoxChannels + 3, 2, 4};
  return {4, shape.data(), CV_32F, cv::Scalar(-20)};
}

TEST(DecodeCells, SidesAreTheMeansOfTheirDistributions) {
  cv::Mat map = EmptyMap();
  const auto set = [&](int channel, float value) { map.ptr<float>(0, channel, 1)[2] = value; };
  // Left: all at 3 strides. Top: half at 0, half at 1. Right: all at 15. Bottom: equal everywhere.
  set(0 * 16 + 3, 20.0F);
  set(1 * 16 + 0, 20.0F);
  set(1 * 16 + 1, 20.0F);
  set(2 * 16 + 15, 20.0F);
  set(kBoxChannels + 1, 2.0F);
  set(kBoxChannels + 2, 0.25F);
  const std::vector<NetworkOutput> outputs = {{"head", map}};
  const auto found =
      DecodeCells(CellLayout(), outputs, {.min_score = 0.5, .classes = {true, true}});
  ASSERT_EQ(found.size(), 1U);
  // The middle of the cell in row 1 and column 2 is at (40, 24).
  EXPECT_NEAR(found[0].least.x(), 40.0 - 3.0 * 16.0, 1e-5);
  EXPECT_NEAR(found[0].least.y(), 24.0 - 0.5 * 16.0, 1e-5);
  EXPECT_NEAR(found[0].greatest.x(), 40.0 + 15.0 * 16.0, 1e-5);
  EXPECT_NEAR(found[0].greatest.y(), 24.0 + 7.5 * 16.0, 1e-5);
  EXPECT_EQ(found[0].class_number, 1);
  EXPECT_NEAR(found[0].score, 0.880797, 1e-6);  // 1 / (1 + exp(-2))
  EXPECT_EQ(found[0].coefficients, Eigen::VectorXf::Constant(1, 0.25F));
  EXPECT_TRUE(
      DecodeCells(CellLayout(), outputs, {.min_score = 0.89, .classes = {true, true}}).empty());
  EXPECT_TRUE(
      DecodeCells(CellLayout(), outputs, {.min_score = 0.5, .classes = {true, false}}).empty());
}

}  // namespace
}  // namespace hullslam
