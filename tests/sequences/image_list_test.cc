// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/image_list.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "hullslam/sequences/image_stream.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

ImageSequence MadeSequence(size_t count) {
  ImageSequence sequence;
  for (size_t i = 0; i < count; ++i) {
    sequence.frames.push_back(
        {.timestamp = static_cast<double>(i), .image = std::to_string(i), .number = i});
  }
  return sequence;
}

std::vector<size_t> Numbers(const ImageSequence& sequence) {
  std::vector<size_t> numbers;
  for (const FramePaths& frame : sequence.frames) {
    numbers.push_back(frame.number);
  }
  return numbers;
}

TEST(ImageList, KeepsTheSelectedFrames) {
  ImageSequence sequence = MadeSequence(10);
  SelectFrames("folder", {.first = 2, .last = 8, .stride = 3}, sequence);
  EXPECT_EQ(Numbers(sequence), (std::vector<size_t>{2, 5, 8}));
  EXPECT_EQ(sequence.available, 10U);
  sequence = MadeSequence(3);
  SelectFrames("folder", {}, sequence);
  EXPECT_EQ(Numbers(sequence), (std::vector<size_t>{0, 1, 2}));
}

TEST(ImageList, ASelectionOutsideOfTheSequenceIsRefused) {
  ImageSequence sequence = MadeSequence(3);
  ExpectInputError([&] { SelectFrames("folder", {.first = 3}, sequence); }, {"folder", "--first"});
}

TEST(ImageList, FramesAreNumberedAndTheirStampsIncrease) {
  const TemporaryFolder folder;
  ListedFrames list;
  ForEachRow(folder.Write("list.txt", "1 a\n2 b\n2 c\n"), [&](const TextRow& row) {
    CheckColumns(row, 2, "timestamp file");
    ExpectInputError([&] { CheckColumns(row, 3, "x y z"); }, {"list.txt", "x y z"});
    const FramePaths frame{.timestamp = row.Stamp(0), .image = ImageFile(row, 1, "images")};
    EXPECT_EQ(AddFrame(row, frame, list), row.line < 3);
  });
  EXPECT_EQ(list.repeated, 1U);
  std::vector<std::string> warnings;
  const std::vector<FramePaths> frames = TakeFrames("list.txt", list, warnings);
  ASSERT_EQ(frames.size(), 2U);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("list.txt:3: "), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("1 of the 3 images"), std::string::npos) << warnings[0];
  ++list.earlier;  // of 3 rows, so this is another kind of list
  ExpectInputError([&] { TakeFrames("list.txt", list, warnings); }, {"list.txt:3: "});
  EXPECT_EQ(frames[1].number, 1U);
  EXPECT_EQ(frames[1].image, fs::path("images/b"));
}

TEST(ImageList, MissingImagesAreNamed) {
  const TemporaryFolder folder;
  const fs::path there = folder.Write("a.png", "x");
  CheckImagesExist({{.timestamp = 0.0, .image = there}});
  ExpectInputError(
      [&] { CheckImagesExist({{.timestamp = 0.0, .image = folder.path() / "b.png"}}); }, {"b.png"});
  ExpectInputError(
      [&] {
        CheckImagesExist({{.timestamp = 0.0, .image = there, .depth = folder.path() / "d.png"}});
      },
      {"d.png"});
}

TEST(ImageList, FoldersAreListedByName) {
  const TemporaryFolder folder;
  for (const char* const name : {"b", "a", "c"}) {
    folder.Write(name, "");
  }
  const std::vector<fs::path> paths = ListFolder(folder.path());
  ASSERT_EQ(paths.size(), 3U);
  EXPECT_EQ(paths[0].filename(), "a");
  EXPECT_EQ(paths[2].filename(), "c");
  EXPECT_THROW(ListFolder(folder.path() / "none"), InputError);
}

TEST(ImageList, ImagesOfAnotherSizeAreRefused) {
  PinholeCamera camera;
  CheckImageSize("a.png", cv::Mat(480, 640, CV_8UC1), camera);
  ExpectInputError([&] { CheckImageSize("a.png", cv::Mat(480, 320, CV_8UC1), camera); },
                   {"a.png", "320x480", "640x480"});
}

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
