// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/resized_images.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "support/expect_error.h"

namespace hullslam {
namespace {

const PinholeCamera kSmall{.fx = 10, .fy = 10, .cx = 1.5, .cy = 0.5, .width = 4, .height = 2};

// A sequence whose only frame is an 8x4 image with a step in the middle.
ImageSequence Made() {
  ImageSequence sequence;
  sequence.load = [](const FramePaths&, const PinholeCamera& camera) {
    EXPECT_EQ(camera.width, 8);
    EXPECT_EQ(camera.height, 4);
    ImageInput image;
    image.grey = cv::Mat(4, 8, CV_8UC1, cv::Scalar(40));
    image.grey.colRange(4, 8).setTo(80);
    image.depth = cv::Mat(4, 8, CV_16UC1, cv::Scalar(1000));
    image.depth.colRange(3, 8).setTo(5000);
    return image;
  };
  sequence.load_colour = [](const FramePaths&) {
    return cv::Mat(4, 8, CV_8UC3, cv::Scalar(1, 2, 3));
  };
  return sequence;
}

TEST(ResizedImages, ImagesDepthAndMasksHaveTheNewSize) {
  ImageSequence sequence = Made();
  ResizeImages(8, 4, kSmall, sequence);
  const ImageInput image = sequence.load({}, kSmall);
  EXPECT_EQ(image.grey.size(), cv::Size(4, 2));
  EXPECT_EQ(image.grey.at<unsigned char>(0, 1), 40);
  EXPECT_EQ(image.grey.at<unsigned char>(1, 2), 80);
  EXPECT_EQ(image.depth.size(), cv::Size(4, 2));
  for (int x = 0; x < 4; ++x) {  // no depth between foreground and background
    const auto depth = image.depth.at<uint16_t>(1, x);
    EXPECT_TRUE(depth == 1000 || depth == 5000) << depth;
  }
  EXPECT_EQ(sequence.load_colour({}).size(), cv::Size(4, 2));
  std::vector<InstanceMask> masks(1);
  masks[0].outlines = {{{-0.5, -0.5}, {7.5, -0.5}, {7.5, 3.5}}};
  FitMasks(sequence.warps, ImageSide::kLeft, masks);
  EXPECT_EQ(masks[0].outlines[0][2], Eigen::Vector2d(3.5, 1.5));
  EXPECT_EQ(masks[0].outlines[0][0], Eigen::Vector2d(-0.5, -0.5));
  EXPECT_EQ(sequence.choices.at("resized_from"), "8x4");
  EXPECT_EQ(SizeAsRead(sequence, kSmall), cv::Size(8, 4));
}

TEST(ResizedImages, TheKeptSizeIsReadAgain) {
  ImageSequence sequence = Made();
  ResizeImages("8x4", kSmall, sequence);
  EXPECT_EQ(sequence.load({}, kSmall).grey.size(), cv::Size(4, 2));
  ImageSequence same = Made();
  ResizeImages("", kSmall, same);
  EXPECT_TRUE(same.warps.empty());
  for (const char* const bad : {"8", "8x", "x4", "8x-4", "8x4x", "0x4"}) {
    ExpectInputError([&] { ResizeImages(bad, kSmall, same); }, {"resized_from is", "1280x720"});
  }
}

}  // namespace
}  // namespace hullslam
