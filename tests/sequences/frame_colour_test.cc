// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/frame_colour.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "hullslam/sequences/image_stream.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr PinholeCamera kCamera{.width = 64, .height = 48};

TEST(FindFrameAt, FindsTheNearestFrameOfTheSameMoment) {
  ImageSequence sequence;
  for (const double timestamp : {1305031102.175304, 1305031102.211214, 1305031102.2116}) {
    sequence.frames.push_back({.timestamp = timestamp, .image = {}});
  }
  EXPECT_EQ(FindFrameAt(sequence, 1305031102.175304), &sequence.frames[0]);
  EXPECT_EQ(FindFrameAt(sequence, 1305031102.1745), &sequence.frames[0]);
  EXPECT_EQ(FindFrameAt(sequence, 1305031102.211215), &sequence.frames[1]);
  EXPECT_EQ(FindFrameAt(sequence, 1305031102.2117), &sequence.frames[2]);
  EXPECT_EQ(FindFrameAt(sequence, 1305031102.2), nullptr);
  EXPECT_EQ(FindFrameAt(sequence, 1305031103.0), nullptr);
  EXPECT_EQ(FindFrameAt({}, 1.0), nullptr);
}

TEST(LoadColour, ImagesOfFilesAndVideosHaveBlueFirst) {
  const TemporaryFolder folder;
  const cv::Mat image(48, 64, CV_8UC3, cv::Scalar(200, 100, 50));
  const std::string file = folder.path() / "a.png";
  cv::imwrite(file, image);
  const cv::Mat of_file = LoadColour({}, {.timestamp = 0.0, .image = file}, kCamera);
  EXPECT_EQ(of_file.at<cv::Vec3b>(24, 32), cv::Vec3b(200, 100, 50));
  const std::string video = folder.path() / "a.avi";
  cv::VideoWriter writer(video, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0, image.size());
  writer.write(image);
  writer.write(image);
  writer.release();
  const ImageSequence sequence = OpenImageStream(video).images;
  const cv::Mat of_video = LoadColour(sequence, sequence.frames.at(1), kCamera);
  ASSERT_EQ(of_video.type(), CV_8UC3);
  const cv::Vec3b pixel = of_video.at<cv::Vec3b>(24, 32);
  EXPECT_NEAR(pixel[0], 200, 12);
  EXPECT_NEAR(pixel[2], 50, 12);
}

TEST(LoadColour, TheImageMustHaveTheSizeOfTheCamera) {
  ImageSequence sequence;
  sequence.load_colour = [](const FramePaths&) { return cv::Mat(10, 20, CV_8UC3); };
  const FramePaths frame{.timestamp = 0.0, .image = "a.png"};
  ExpectInputError([&] { LoadColour(sequence, frame, kCamera); }, {"a.png", "20x10", "64x48"});
  EXPECT_EQ(LoadColour(sequence, frame, {.width = 20, .height = 10}).cols, 20);
}

TEST(LoadColour, AMissingFileIsAnError) {
  const FramePaths frame{.timestamp = 0.0, .image = "missing.png"};
  ExpectInputError([&] { LoadColour({}, frame, kCamera); }, {"missing.png"});
}

}  // namespace
}  // namespace hullslam
