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

// YOLO's training puts the smaller half of an odd border on the left and at the top.
TEST(Letterbox, OfAnOddBorderTheSmallerHalfComesFirst) {
  const auto expect = [](const cv::Size& image, const Eigen::Array2d& offset) {
    const Letterbox box = FitLetterbox(image, {64, 64});
    EXPECT_TRUE((box.offset == offset).all()) << box.offset.transpose();
    const cv::Mat input = MakeInput(cv::Mat(image, CV_8UC1, cv::Scalar(255)), box);
    for (int row = 0; row < 64; ++row) {
      for (int column = 0; column < 64; ++column) {
        const cv::Rect inside({static_cast<int>(offset.x()), static_cast<int>(offset.y())}, image);
        EXPECT_FLOAT_EQ(input.ptr<float>(0, 1, row)[column],
                        inside.contains({column, row}) ? 1.0F : 114.0F / 255.0F)
            << column << ", " << row;
      }
    }
  };
  expect({64, 37}, {0.0, 13.0});  // 13 rows above and 14 below
  expect({37, 64}, {13.0, 0.0});
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
