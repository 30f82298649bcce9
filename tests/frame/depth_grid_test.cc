// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/depth_grid.h"

#include <gtest/gtest.h>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

TEST(DepthGrid, HasTheDepthOfEveryEighthPixel) {
  cv::Mat depth(30, 44, CV_16UC1, cv::Scalar(0));
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      depth.at<uint16_t>(y, x) = static_cast<uint16_t>(5 * (100 * y + x));
    }
  }
  const DepthGrid grid(depth, 5000.0);
  ASSERT_EQ(grid.columns(), 5);  // 4 12 20 28 36; 44 is outside
  ASSERT_EQ(grid.rows(), 4);     // 4 12 20 28
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      const Eigen::Vector2d raw = DepthGrid::RawPixel(column, row);
      EXPECT_NEAR(grid.At(column, row), 1e-3 * (100.0 * raw.y() + raw.x()), 1e-9);
    }
  }
}

TEST(DepthGrid, UnknownIsZeroAndFarIsTheFarthest) {
  cv::Mat metres(8, 24, CV_32FC1, cv::Scalar(0.0f));
  metres.at<float>(4, 12) = 1.2346f;
  metres.at<float>(4, 20) = 1000.0f;
  const DepthGrid grid(metres, 1.0);
  EXPECT_EQ(grid.At(0, 0), 0.0);
  EXPECT_NEAR(grid.At(1, 0), 1.235, 1e-9);
  EXPECT_NEAR(grid.At(2, 0), 65.535, 1e-9);
}

TEST(DepthGrid, IsEmptyWithoutDepth) {
  EXPECT_TRUE(DepthGrid().empty());
  EXPECT_TRUE(DepthGrid(cv::Mat(), 5000.0).empty());
  EXPECT_EQ(DepthGrid().rows(), 0);
}

TEST(DepthGrid, IsRestoredFromItsSamples) {
  const DepthGrid grid(cv::Mat(100, 130, CV_32FC1, cv::Scalar(1.5)), 5000.0);
  const DepthGrid copy(grid.columns(), grid.samples());
  EXPECT_EQ(copy.columns(), DepthGrid::CountAlong(130));
  EXPECT_EQ(copy.rows(), DepthGrid::CountAlong(100));
  EXPECT_EQ(copy.At(3, 2), grid.At(3, 2));
  EXPECT_EQ(copy.samples(), grid.samples());
  EXPECT_THROW(DepthGrid(4, std::vector<uint16_t>(10)), CheckError);
  EXPECT_THROW(DepthGrid(0, std::vector<uint16_t>(10)), CheckError);
}

}  // namespace
}  // namespace hullslam
