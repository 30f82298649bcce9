// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/letterbox.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace hullslam {
namespace {

TEST(Letterbox, InputsHaveTheProportionsOfTheImageInMultiplesOf32) {
  EXPECT_EQ(InputSize({640, 480}, 640), cv::Size(640, 480));
  EXPECT_EQ(InputSize({1226, 370}, 1226), cv::Size(1248, 384));
  EXPECT_EQ(InputSize({1080, 1920}, 640), cv::Size(384, 640));  // 360 columns
}

TEST(Letterbox, PointsGoBackToTheImage) {
  const Letterbox box = FitLetterbox({1226, 370}, {640, 480});
  EXPECT_EQ(box.scaled, cv::Size(640, 193));
  const Eigen::Array2d point(100.25, 300.5);
  EXPECT_TRUE(box.ToImage(point * box.scale + box.offset).isApprox(point));
  EXPECT_TRUE(box.ToImage(box.offset).isApprox(Eigen::Array2d(0.0, 0.0)));
}

TEST(Letterbox, TheInputHasRedFirstAndGreyBorders) {
  const cv::Mat image(32, 64, CV_8UC3, cv::Scalar(0, 51, 255));  // blue, green, red
  const Letterbox box = FitLetterbox(image.size(), {64, 64});
  const cv::Mat input = MakeInput(image, box);
  ASSERT_EQ(input.dims, 4);
  const auto at = [&](int channel, int row) { return input.ptr<float>(0, channel, row)[5]; };
  EXPECT_FLOAT_EQ(at(0, 15), 114.0F / 255.0F);
  EXPECT_FLOAT_EQ(at(0, 16), 1.0F);
  EXPECT_FLOAT_EQ(at(1, 47), 0.2F);
  EXPECT_FLOAT_EQ(at(2, 47), 0.0F);
  EXPECT_FLOAT_EQ(at(2, 48), 114.0F / 255.0F);
  const cv::Mat grey(32, 64, CV_8UC1, cv::Scalar(51));
  EXPECT_FLOAT_EQ(MakeInput(grey, box).ptr<float>(0, 2, 20)[7], 0.2F);
}

}  // namespace
}  // namespace hullslam
