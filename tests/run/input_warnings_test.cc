// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/input_warnings.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/masks/mask_source.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// Seven images of a bright rectangle from (100, 60) to (300, 160).
ImageSequence MadeSequence() {
  ImageSequence sequence;
  for (size_t i = 0; i < 7; ++i) {
    sequence.frames.push_back({0.1 * static_cast<double>(i), std::to_string(i) + ".jpg", {}, i});
  }
  sequence.load = [](const FramePaths& frame, const PinholeCamera&) {
    cv::Mat image(480, 640, CV_8UC1);
    cv::theRNG().state = 5;
    cv::randu(image, 0, 20);
    image(cv::Rect(100, 60, 200, 100)) += 150;
    return ImageInput{frame.timestamp, image, cv::Mat()};
  };
  return sequence;
}

// What is printed for masks that all are a rectangle of class 41 with these corners, in shares.
// `warps` move them from the images as read to the rectified ones.
std::string WarningOf(double x0, double y0, double x1, double y1,
                      std::vector<ImageWarp> warps = {}) {
  const TemporaryFolder folder;
  const auto text = [](double value) { return " " + std::to_string(value); };
  for (int i = 0; i < 7; ++i) {
    folder.Write(std::to_string(i) + ".txt", "41" + text(x0) + text(y0) + text(x1) + text(y0) +
                                                 text(x1) + text(y1) + text(x0) + text(y1) + "\n");
  }
  ImageSequence sequence = MadeSequence();
  sequence.warps = std::move(warps);
  const SequenceMasks masks({folder.path(), "yolo-seg", 640, 480}, MaskFrames(sequence));
  testing::internal::CaptureStderr();
  try {
    WarnOfMisplacedMasks(sequence, {.width = 640, .height = 480},
                         [&](size_t frame) { return masks.Read(frame); });
  } catch (...) {
    testing::internal::GetCapturedStderr();
    throw;
  }
  return testing::internal::GetCapturedStderr();
}

TEST(InputWarningsTest, MasksThatFitTheTurnedImagesAreNoticed) {
  EXPECT_EQ(WarningOf(100.0 / 640, 60.0 / 480, 300.0 / 640, 160.0 / 480), "");
  // The pixel (x, y) is at (479 - y, x) in the image that is turned clockwise.
  const std::string turned = WarningOf(320.0 / 480, 100.0 / 640, 420.0 / 480, 300.0 / 640);
  EXPECT_NE(turned.find("the EXIF orientation 6."), std::string::npos) << turned;
}

// Rectification moves the images by 40 px to the right.
TEST(InputWarningsTest, MasksOfRectifiedImagesAreRefused) {
  const std::vector<ImageWarp> move = {{.pixel = [](const Eigen::Vector2d& pixel, ImageSide) {
    return Eigen::Vector2d(pixel.x() + 40.0, pixel.y());
  }}};
  EXPECT_EQ(WarningOf(60.0 / 640, 60.0 / 480, 260.0 / 640, 160.0 / 480, move), "");
  ExpectInputError([&] { WarningOf(100.0 / 640, 60.0 / 480, 300.0 / 640, 160.0 / 480, move); },
                   {"fit the rectified or resized images", "expected masks of the images as read"});
}

TEST(InputWarningsTest, MasksOfOtherImagesAreNoticed) {
  const std::string other = WarningOf(0.5, 0.4, 0.9, 0.9);
  EXPECT_NE(other.find("are they the masks of these images?"), std::string::npos) << other;
}

}  // namespace
}  // namespace hullslam
