// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/datasets/input_checks.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/masks/open_masks.h"
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

// The warning for masks that all are a rectangle of class 41 with these corners, in shares.
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
  const std::vector<MaskFrame> frames = MaskFrames(sequence);
  const auto masks = OpenMasks({folder.path(), "yolo-seg", 640, 480}, frames);
  const std::vector<std::string> warnings =
      CheckMaskPlaces(sequence, {.width = 640, .height = 480},
                      [&](size_t frame) { return masks->Read(frames[frame]).masks; });
  return warnings.empty() ? std::string() : warnings.at(0);
}

TEST(InputChecks, MasksThatFitTheTurnedImagesAreNoticed) {
  EXPECT_EQ(WarningOf(100.0 / 640, 60.0 / 480, 300.0 / 640, 160.0 / 480), "");
  // The pixel (x, y) is at (479 - y, x) in the image that is turned clockwise.
  const std::string turned = WarningOf(320.0 / 480, 100.0 / 640, 420.0 / 480, 300.0 / 640);
  EXPECT_NE(turned.find("the EXIF orientation 6."), std::string::npos) << turned;
}

// Rectification moves the images by 40 px to the right.
TEST(InputChecks, MasksOfRectifiedImagesAreRefused) {
  const std::vector<ImageWarp> move = {{.pixel = [](const Eigen::Vector2d& pixel, ImageSide) {
    return Eigen::Vector2d(pixel.x() + 40.0, pixel.y());
  }}};
  EXPECT_EQ(WarningOf(60.0 / 640, 60.0 / 480, 260.0 / 640, 160.0 / 480, move), "");
  ExpectInputError([&] { WarningOf(100.0 / 640, 60.0 / 480, 300.0 / 640, 160.0 / 480, move); },
                   {"fit the rectified or resized images", "expected masks of the images as read"});
}

TEST(InputChecks, MasksOfOtherImagesAreNoticed) {
  const std::string other = WarningOf(0.5, 0.4, 0.9, 0.9);
  EXPECT_NE(other.find("are they the masks of these images?"), std::string::npos) << other;
}

TEST(InputChecks, ClassesThatNoMaskHasAndLargeSizesAreNoticed) {
  SystemOptions options;
  const auto check = [&] {
    return CheckClasses(options, [] { return std::set<std::string>{"cup"}; });
  };
  EXPECT_TRUE(check().empty());
  options.tracking.dynamic_classes += ",cat";
  options.objects.sizes = {{"cup", 12.0}};
  const std::vector<std::string> warnings = check();
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].find("'cup' is 12 m"), std::string::npos) << warnings[0];
  EXPECT_EQ(warnings[1],
            "tracking.dynamic_classes has 'cat', but no mask has this class; classes of the masks: "
            "cup");
}

TEST(InputChecks, ALastFrameBeyondTheEndIsNoticed) {
  ImageSequence sequence;
  sequence.available = 7;
  EXPECT_TRUE(CheckLastFrame({.last = 6}, sequence).empty());
  EXPECT_TRUE(CheckLastFrame({}, sequence).empty());
  EXPECT_EQ(CheckLastFrame({.last = 7}, sequence).size(), 1U);
}

}  // namespace
}  // namespace hullslam
