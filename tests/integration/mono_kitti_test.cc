// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "support/mono_program.h"
#include "support/rendered_desk.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kDeskFrames = 16;

class MonoKitti : public MonoProgram {
 protected:
  MonoKitti() : MonoProgram("mono_kitti") {}

  // Writes the desk as the left camera of a sequence of KITTI, with stamps from 0.
  void WriteDesk(const RenderedDesk& desk) const {
    const ImageSequence images = desk.images();
    const double begin = images.frames.front().timestamp;
    fs::create_directories(fs::path(path_) / "image_0");
    std::string times;
    for (size_t i = 0; i < images.frames.size(); ++i) {
      cv::imwrite((fs::path(path_) / fmt::format("image_0/{:06}.png", i)).string(),
                  cv::imread(images.frames[i].image.string(), cv::IMREAD_GRAYSCALE));
      times += fmt::format("{:.6f}\n", images.frames[i].timestamp - begin);
    }
    folder_.Write("sequence/times.txt", times);
    const PinholeCamera& camera = desk.camera();
    folder_.Write("sequence/calib.txt", fmt::format("P0: {} 0 {} 0 0 {} {} 0 0 0 1 0\n", camera.fx,
                                                    camera.cx, camera.fy, camera.cy));
    Trajectory truth = ReadGroundtruth(images).value();
    for (StampedPose& pose : truth) {
      pose.timestamp -= begin;
    }
    folder_.Write("sequence/groundtruth.txt", FormatTrajectory(truth));
  }
};

TEST_F(MonoKitti, MakesAMapWithTheLeftCameraOfTheSequence) {
  const RenderedDesk desk(kDeskFrames);
  WriteDesk(desk);
  ExpectMap({path_}, kDeskFrames);
  EXPECT_LE(Ate(), 0.005);
  EXPECT_EQ(Summary()["trajectory"]["pairs"], kDeskFrames);
  const std::string poses = ReadFile(output_ / "trajectory.txt");
  ExpectMap({path_, "--settings", desk.settings(), "--set", "Camera.fps=30"}, kDeskFrames);
  EXPECT_TRUE(ReadFile(output_ / "trajectory.txt") == poses) << "the camera is the same";
  const ProgramResult other =
      Run({path_, "--settings", desk.settings(), "--set", "Camera.width=320"});
  EXPECT_EQ(other.exit_code, 2) << "the camera of the settings counts";
}

TEST_F(MonoKitti, BrokenFoldersAreRefused) { ExpectRefusal({path_}, {path_, "image_0", "KITTI"}); }

// A car moves forward, towards what it sees.
TEST_F(MonoKitti, ADriveForwardIsMapped) {
  const auto data = FindTestData("kitti_pairs_seq1");
  if (!data) {
    GTEST_SKIP() << "the pairs of KITTI are not on this machine";
  }
  const ProgramResult result = Run({data->string()});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_GE(Summary()["trajectory"]["tracked"], 47) << "of 51";
  EXPECT_LT(Ate(), 0.1) << "of 57 m";
}

}  // namespace
}  // namespace hullslam
