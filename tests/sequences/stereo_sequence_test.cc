// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/stereo_sequence.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

class StereoSequenceTest : public ::testing::Test {
 protected:
  void WriteImage(const std::string& name, int grey = 100, int width = 20) {
    const fs::path path = folder_.path() / name;
    fs::create_directories(path.parent_path());
    cv::imwrite(path.string(), cv::Mat(10, width, CV_8UC1, cv::Scalar(grey)));
  }
  // Two pairs of KITTI with a baseline of 0.5 m.
  void WriteKitti() {
    for (const char* const name : {"000000.png", "000001.png"}) {
      WriteImage(std::string("image_0/") + name, 100);
      WriteImage(std::string("image_1/") + name, 200);
    }
    folder_.Write("calib.txt", kCalibration);
    folder_.Write("times.txt", "0.0\n1.0e-01\n");
  }
  void ExpectKittiError(const std::vector<std::string>& parts) {
    ExpectInputError([&] { OpenKittiPairs(folder_.path()); }, parts);
  }

  static constexpr const char* kCalibration =
      "P0: 700 0 10 0 0 700 5 0 0 0 1 0\nP1: 700 0 10 -350 0 700 5 0 0 0 1 0\n"
      "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n";
  TemporaryFolder folder_;
};

TEST_F(StereoSequenceTest, KittiIsReadWithCalibrationTimesAndTruth) {
  WriteKitti();
  folder_.Write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0.5\n");
  const StereoSequence sequence = OpenKittiPairs(folder_.path());
  const PinholeCamera& camera = sequence.calibration.camera;
  EXPECT_EQ(camera.fx, 700.0);
  EXPECT_EQ(camera.cy, 5.0);
  EXPECT_EQ(camera.bf, 350.0);
  EXPECT_EQ(camera.width, 20);
  EXPECT_DOUBLE_EQ(sequence.calibration.frames_per_second, 10.0);
  ASSERT_EQ(sequence.images.frames.size(), 2u);
  EXPECT_EQ(sequence.images.frames[1].timestamp, 0.1);
  const ImageInput pair = sequence.images.load(sequence.images.frames[1], camera);
  EXPECT_EQ(pair.grey.at<uint8_t>(0, 0), 100);
  EXPECT_EQ(pair.right.at<uint8_t>(0, 0), 200);
  const auto truth = ReadGroundtruth(sequence.images);
  ASSERT_TRUE(truth);
  EXPECT_EQ(truth->back().timestamp, 0.1);
  EXPECT_EQ(truth->back().world_from_cam.translation.z(), 0.5);
}

TEST_F(StereoSequenceTest, TheTruthOfKittiMayLieBesideTheSequences) {
  WriteKitti();
  const fs::path sequence = folder_.path() / "sequences" / "07";
  fs::create_directories(sequence);
  for (const char* const name : {"image_0", "image_1", "calib.txt", "times.txt"}) {
    fs::rename(folder_.path() / name, sequence / name);
  }
  folder_.Write("poses/07.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0.5\n");
  EXPECT_EQ(ReadGroundtruth(OpenKittiPairs(sequence).images)->size(), 2u);
}

TEST_F(StereoSequenceTest, TheLeftCameraOfKittiNeedsNoRightOne) {
  WriteKitti();
  fs::remove_all(folder_.path() / "image_1");
  folder_.Write("calib.txt", "P0: 700 0 10 0 0 701 5 0 0 0 1 0\n");
  folder_.Write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0.5\n");
  const LeftSequence sequence = OpenKittiImages(folder_.path());
  const PinholeCamera& camera = sequence.calibration.camera;
  EXPECT_EQ(camera.fx, 700.0);
  EXPECT_EQ(camera.fy, 701.0);
  EXPECT_EQ(camera.bf, PinholeCamera().bf);
  EXPECT_DOUBLE_EQ(sequence.calibration.frames_per_second, 10.0);
  ASSERT_EQ(sequence.images.frames.size(), 2u);
  EXPECT_TRUE(sequence.images.frames[1].right.empty());
  const ImageInput image = sequence.images.load(sequence.images.frames[1], camera);
  EXPECT_EQ(image.timestamp, 0.1);
  EXPECT_EQ(image.grey.at<uint8_t>(0, 0), 100);
  EXPECT_TRUE(image.right.empty());
  EXPECT_EQ(ReadGroundtruth(sequence.images)->size(), 2u);
  EXPECT_EQ(OpenKittiImages(folder_.path(), {.first = 1}).images.frames.size(), 1u);
}

TEST_F(StereoSequenceTest, TheColourImagesOfKittiHaveTheirOwnProjection) {
  WriteKitti();
  fs::rename(folder_.path() / "image_0", folder_.path() / "image_2");
  ExpectInputError([&] { OpenKittiImages(folder_.path()); }, {"calib.txt", "'P2:'"});
  folder_.Write("calib.txt", std::string(kCalibration) + "P2: 650 0 11 30 0 650 5 0 0 0 1 0\n");
  EXPECT_EQ(OpenKittiImages(folder_.path()).calibration.camera.fx, 650.0);
}

// The folder of a drive has no calibration of its own: it is that of the day.
TEST_F(StereoSequenceTest, DrivesOfTheRawDataOfKittiAreRead) {
  for (const char* const name : {"0000000000.png", "0000000001.png"}) {
    WriteImage(std::string("day/drive/image_02/data/") + name, 100);
    WriteImage(std::string("day/drive/image_03/data/") + name, 200);
  }
  const fs::path drive = folder_.path() / "day" / "drive";
  folder_.Write("day/drive/image_02/timestamps.txt",
                "2011-09-26 23:59:59.950000000\n2011-09-27 00:00:00.050000000\n");
  folder_.Write("day/calib_cam_to_cam.txt",
                "calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.95e-02\n"
                "P_rect_02: 700 0 10 45 0 700 5 0 0 0 1 0\n"
                "P_rect_03: 700 0 10 -305 0 700 5 0 0 0 1 0\n");
  const StereoSequence sequence = OpenKittiPairs(drive);
  EXPECT_EQ(sequence.calibration.camera.bf, 350.0);
  ASSERT_EQ(sequence.images.frames.size(), 2u);
  EXPECT_NEAR(sequence.images.frames[0].timestamp, 1317081599.95, 1e-6);
  EXPECT_NEAR(sequence.calibration.frames_per_second, 10.0, 1e-3);
  EXPECT_EQ(OpenKittiImages(drive).calibration.camera.fx, 700.0);
  folder_.Write("day/drive/image_02/timestamps.txt", "2011-13-26 23:59:59\n2011-09-27 0:0:0\n");
  ExpectInputError([&] { OpenKittiPairs(drive); }, {"timestamps.txt:1", "a date and a time"});
  fs::remove(folder_.path() / "day" / "calib_cam_to_cam.txt");
  ExpectInputError([&] { OpenKittiPairs(drive); }, {"calib_cam_to_cam.txt"});
}

TEST_F(StereoSequenceTest, FoldersOfTheRawDataMayHaveFilesOfTheBenchmark) {
  WriteKitti();
  for (const char* const side : {"0", "1"}) {
    const fs::path images = folder_.path() / (std::string("image_0") + side);
    fs::create_directory(images);
    fs::rename(folder_.path() / (std::string("image_") + side), images / "data");
  }
  EXPECT_EQ(OpenKittiPairs(folder_.path()).calibration.camera.bf, 350.0);
  folder_.Write(
      "calib.txt",
      "P_rect_00: 710 0 10 0 0 710 5 0 0 0 1 0\nP_rect_01: 710 0 10 -355 0 710 5 0 0 0 1 0\n");
  EXPECT_EQ(OpenKittiPairs(folder_.path()).calibration.camera.bf, 355.0);
}

TEST_F(StereoSequenceTest, PairsOfTartanAirHaveTheirTruth) {
  for (const char* const name : {"000000", "000001"}) {
    WriteImage(std::string("image_left/") + name + "_left.png");
    WriteImage(std::string("image_right/") + name + "_right.png");
  }
  folder_.Write("pose_left.txt", "1 2 3 0 0 0 1\n1 2 4 0 0 0 1\n");
  const ImageSequence sequence = OpenStereoFolder(folder_.path(), {.frames_per_second = 10.0});
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.frames[1].right.filename(), "000001_right.png");
  const auto truth = ReadGroundtruth(sequence);
  ASSERT_TRUE(truth);
  EXPECT_EQ(truth->back().timestamp, sequence.frames[1].timestamp);
}

TEST_F(StereoSequenceTest, BrokenFilesOfKittiAreRefused) {
  ExpectKittiError({"has no folder image_0", "KITTI"});
  WriteKitti();
  folder_.Write("calib.txt", "P0: 700 0 10 0 0 700 5 0 0 0 1 0\n");
  ExpectKittiError({"calib.txt", "'P1:'", "'P_rect_01:'"});
  folder_.Write("calib.txt", "P0: 700 0 10\n");
  ExpectKittiError({"calib.txt:1: 4 column(s), expected 13"});
  folder_.Write("calib.txt", "P0: 700 0 10 0 0 x 5 0 0 0 1 0\n");
  ExpectKittiError({"calib.txt:1: ", "'x'"});
  folder_.Write("calib.txt",
                "P1: 700 0 10 0 0 700 5 0 0 0 1 0\nP0: 700 0 10 -350 0 700 5 0 0 0 1 0\n");
  ExpectKittiError({"calib.txt", "swapped"});
  folder_.Write("calib.txt", kCalibration);
  folder_.Write("times.txt", "0.0\n");
  ExpectKittiError({"times.txt: has 1 times", "2 images"});
  folder_.Write("times.txt", "0.0\n0.1\n");
  fs::remove(folder_.path() / "image_1/000001.png");
  ExpectKittiError({"image_1/000001.png: the image is missing"});
}

TEST_F(StereoSequenceTest, FoldersOfPairsAreReadByTheirNames) {
  for (const char* const name : {"1.png", "2.png", "10.png"}) {
    WriteImage(std::string("left/") + name, 10);
    WriteImage(std::string("right/") + name, 20);
  }
  const ImageSequence sequence = OpenStereoFolder(folder_.path(), {.frames_per_second = 10.0});
  ASSERT_EQ(sequence.frames.size(), 3u);
  EXPECT_EQ(sequence.frames[2].image.filename(), "10.png");
  EXPECT_EQ(sequence.frames[2].right.filename(), "10.png");
  EXPECT_DOUBLE_EQ(sequence.frames[1].timestamp - sequence.frames[0].timestamp, 0.1);
  fs::remove(folder_.path() / "right/2.png");
  const ImageSequence fewer = OpenStereoFolder(folder_.path());
  ASSERT_EQ(fewer.frames.size(), 2u);
  EXPECT_EQ(fewer.frames[1].right.filename(), "10.png");
  EXPECT_EQ(fewer.unpaired, 1u);
  ASSERT_EQ(fewer.warnings.size(), 1u);
  EXPECT_NE(fewer.warnings[0].find("1 of 3 images"), std::string::npos) << fewer.warnings[0];
  fs::remove_all(folder_.path() / "right");
  ExpectInputError([&] { OpenStereoFolder(folder_.path()); }, {"a folder left but none right"});
}

TEST_F(StereoSequenceTest, FoldersWithOtherNamesMustHaveAsManyImages) {
  WriteImage("left/l1.png");
  WriteImage("left/l2.png");
  WriteImage("right/r11.png");
  ExpectInputError([&] { OpenStereoFolder(folder_.path()); },
                   {"left has 2 images", "0 of them", "1 of"});
  WriteImage("right/r12.png");
  EXPECT_EQ(OpenStereoFolder(folder_.path()).frames[1].right.filename(), "r12.png");
}

// The first right and the last left image are missing, so both folders have as many images.
TEST_F(StereoSequenceTest, PairsShareTheirNamesWhicheverImagesAreMissing) {
  for (int i = 0; i < 6; ++i) {
    if (i < 5) {
      WriteImage("left/" + std::to_string(100 + i) + ".png");
    }
    if (i > 0) {
      WriteImage("right/" + std::to_string(100 + i) + ".png");
    }
  }
  const ImageSequence sequence = OpenStereoFolder(folder_.path());
  ASSERT_EQ(sequence.frames.size(), 4u);
  for (const FramePaths& frame : sequence.frames) {
    EXPECT_EQ(frame.image.filename(), frame.right.filename());
  }
  EXPECT_EQ(sequence.unpaired, 1u);
}

TEST_F(StereoSequenceTest, NamesThatTellTheSideShareTheirNumbers) {
  for (int i = 0; i < 6; ++i) {
    if (i != 2) {
      WriteImage("left/left_00" + std::to_string(i) + ".png");
    }
    if (i != 4) {
      WriteImage("right/right_" + std::to_string(i) + ".png");
    }
  }
  const ImageSequence sequence = OpenStereoFolder(folder_.path());
  ASSERT_EQ(sequence.frames.size(), 4u);
  for (const FramePaths& frame : sequence.frames) {
    const std::string left = frame.image.stem().string();
    EXPECT_EQ(left.back(), frame.right.stem().string().back()) << left;
  }
  EXPECT_EQ(sequence.frames[3].number, 3u);
}

TEST_F(StereoSequenceTest, FoldersWithFewPairsAreRefused) {
  for (int i = 0; i < 6; ++i) {
    WriteImage("left/" + std::to_string(i) + ".png");
  }
  WriteImage("right/2.png");
  WriteImage("right/3.png");
  ExpectInputError([&] { OpenStereoFolder(folder_.path()); }, {"6 images", "2 of them"});
}

TEST_F(StereoSequenceTest, ImagesSideBySideAreSplit) {
  cv::Mat both(10, 40, CV_8UC1, cv::Scalar(10));
  both.colRange(20, 40) = cv::Scalar(20);
  cv::imwrite((folder_.path() / "0.png").string(), both);
  const ImageSequence sequence = OpenStereoFolder(folder_.path());
  PinholeCamera camera{.fx = 20.0, .fy = 20.0, .cx = 10.0, .cy = 5.0, .width = 20, .height = 10};
  const ImageInput pair = sequence.load(sequence.frames[0], camera);
  EXPECT_EQ(pair.grey.cols, 20);
  EXPECT_EQ(pair.grey.at<uint8_t>(5, 19), 10);
  EXPECT_EQ(pair.right.at<uint8_t>(5, 0), 20);
  EXPECT_EQ(sequence.load_colour(sequence.frames[0]).cols, 20);
  camera.width = 40;
  ExpectInputError([&] { sequence.load(sequence.frames[0], camera); }, {"40x10", "80x10"});
}

}  // namespace
}  // namespace hullslam
