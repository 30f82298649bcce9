// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/image_input.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace hullslam {
namespace {

// Stages pass images on by value. This shares the pixels and does not copy them.
TEST(ImageInput, CopiesShareThePixels) {
  ImageInput image{.timestamp = 2.5,
                   .grey = cv::Mat(4, 6, CV_8UC1, cv::Scalar(9)),
                   .depth = cv::Mat(4, 6, CV_16UC1, cv::Scalar(5000))};
  const ImageInput copy = image;
  EXPECT_EQ(copy.timestamp, 2.5);
  EXPECT_EQ(copy.grey.data, image.grey.data);
  EXPECT_EQ(copy.depth.data, image.depth.data);
}

TEST(ImageInput, StartsEmpty) {
  const ImageInput image;
  EXPECT_TRUE(image.grey.empty());
  EXPECT_TRUE(image.depth.empty());
  EXPECT_EQ(image.timestamp, 0.0);
}

}  // namespace
}  // namespace hullslam
