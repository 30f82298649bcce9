// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "hullslam/eval/ate.h"
#include "support/mono_program.h"
#include "support/rendered_desk.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kVideoFrames = 16;

class MonoVideo : public MonoProgram {
 protected:
  MonoVideo() : MonoProgram("mono_video") {}

  std::string Path(const std::string& name) const { return folder_.path() / name; }

  // A video with 30 frames per second.
  std::string WriteVideo(const RenderedDesk& desk) const {
    cv::VideoWriter writer(Path("desk.avi"), cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 30.0, cv::Size(640, 480));
    for (const FramePaths& frame : desk.images().frames) {
      writer.write(cv::imread(frame.image.string()));
    }
    return Path("desk.avi");
  }

  // Writes a folder of black images.
  std::string WriteBlack(int frames) const {
    fs::create_directory(Path("black"));
    for (int i = 0; i < frames; ++i) {
      cv::imwrite(Path(fmt::format("black/{}.png", i)),
                  cv::Mat(300, 400, CV_8UC3, cv::Scalar::all(0)));
    }
    return Path("black");
  }

  // The error of the last run, m. The time stamps of the run begin at 0.
  double AteOf(const RenderedDesk& desk) const {
    Trajectory truth = ReadGroundtruth(desk.images()).value();
    const double start = truth.front().timestamp;
    for (StampedPose& pose : truth) {
      pose.timestamp -= start;
    }
    const AteResult ate = EvaluateAte(truth, Poses(), {.alignment = AlignmentKind::kSim3});
    EXPECT_TRUE(ate.ok()) << ate.failure;
    EXPECT_EQ(ate.pairs, static_cast<size_t>(kVideoFrames));
    return ate.errors.rmse;
  }
};

TEST_F(MonoVideo, AVideoAndAFolderOfImagesMakeAMap) {
  const RenderedDesk desk(kVideoFrames);
  const std::string video = WriteVideo(desk);
  const ProgramResult calibrated = ExpectMap({video, "--settings", desk.settings()}, kVideoFrames);
  ExpectParts(calibrated.output, {"16 images of 640x480 px", "those of the video, 30 images"});
  EXPECT_EQ(calibrated.output.find("first try"), std::string::npos) << calibrated.output;
  EXPECT_LE(AteOf(desk), 0.005);
  EXPECT_TRUE(Summary()["trajectory"]["ate_rmse_m"].is_null()) << "there is no ground truth";
  const ProgramResult guessed = ExpectMap({video, "--fov", "62"}, kVideoFrames);
  ExpectParts(guessed.output, {"62 degrees", "for a first try only", "use --settings"});
  EXPECT_LE(AteOf(desk), 0.010);
  ExpectMap({video, "--fov", "62", "--fps", "15", "--quiet"}, kVideoFrames);
  EXPECT_NEAR(Poses().back().timestamp, (kVideoFrames - 1) / 15.0, 1e-6);
  const ProgramResult folder =
      ExpectMap({desk.path() / "rgb", "--settings", desk.settings()}, kVideoFrames);
  ExpectParts(folder.output, {"30 images per second, the default"});
  EXPECT_LE(AteOf(desk), 0.005);
}

TEST_F(MonoVideo, TheErrorAgainstGroundTruthNeedsStampsThatFit) {
  const RenderedDesk desk(kVideoFrames);
  const std::string images = desk.path() / "rgb";
  const std::string truth = desk.path() / "groundtruth.txt";
  const double start = ReadGroundtruth(desk.images())->front().timestamp;
  folder_.Write("late.txt", fmt::format("{:.6f} 0 0 0 0 0 0 1\n", start + 1000.0));
  const Arguments camera = {"--settings", desk.settings()};
  Arguments arguments = {images, "--groundtruth", truth, "--stamp-offset",
                         fmt::format("{:.6f}", start)};
  arguments.insert(arguments.end(), camera.begin(), camera.end());
  ExpectMap(arguments, kVideoFrames);
  EXPECT_LE(Ate(), 0.005);
  EXPECT_EQ(Summary()["trajectory"]["pairs"], kVideoFrames);
  EXPECT_NEAR(Poses().front().timestamp, start, 1e-6);
  ExpectRefusal({images, "--fov", "60", "--groundtruth", Path("late.txt")},
                {"late.txt", "but the images are from 0.000000 to 0.5", "--stamp-offset"});
  ExpectRefusal({images, "--fov", "60", "--groundtruth", Path("none.txt")}, {"none.txt"});
  ExpectRefusal({images, "--fov", "60", "--stamp-offset", "nan"}, {"--stamp-offset", "nan"});
}

TEST_F(MonoVideo, BlackImagesMakeNoMap) {
  ExpectNoMap({WriteBlack(12), "--fov", "60"}, 12, "too few features");
}

TEST_F(MonoVideo, TheCameraMustBeGivenInExactlyOneWay) {
  const std::string images = WriteBlack(1);
  const std::string settings = folder_.Write(
      "camera.yaml",
      "%YAML:1.0\nCamera.fx: 500.0\nCamera.fy: 500.0\nCamera.cx: 319.5\nCamera.cy: 239.5\n");
  ExpectRefusal({images}, {"neither --settings nor --fov", "first try"});
  ExpectRefusal({images, "--settings", settings, "--fov", "60"}, {"both given"});
  ExpectRefusal({"none", settings, images, "--fov", "60"}, {"both given"});
  ExpectRefusal({images, "--settings", settings}, {"black/0.png", "400x300", "640x480"});
  for (const char* const degrees : {"5", "180", "wide", "nan"}) {
    ExpectRefusal({images, "--fov", degrees}, {"--fov", degrees});
  }
  for (const char* const rate : {"0", "-3", "fast", "nan"}) {
    ExpectRefusal({images, "--fov", "60", "--fps", rate}, {"--fps", rate});
  }
  ExpectRefusal({images, "--fov", "60", "--set", "Camera.fx=1"}, {"--set", "Camera.fx is '1'"});
}

TEST_F(MonoVideo, WhatCannotBeDecodedIsRefused) {
  ExpectRefusal({folder_.Write("a.mp4", "no video"), "--fov", "60"},
                {"a.mp4: cannot be decoded", "FFmpeg"});
  ExpectRefusal({Path("none.mp4"), "--fov", "60"}, {"none.mp4: no such file or folder"});
  fs::create_directory(Path("empty"));
  ExpectRefusal({Path("empty"), "--fov", "60"}, {"empty: has no PNG or JPEG images"});
  cv::imwrite(Path("empty/a.png"), cv::Mat(200, 300, CV_16UC1, cv::Scalar(900)));
  ExpectRefusal({Path("empty"), "--fov", "60"}, {"a.png: has 16 bits per channel"});
}

}  // namespace
}  // namespace hullslam
