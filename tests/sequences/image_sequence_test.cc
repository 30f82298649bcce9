// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/image_sequence.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "hullslam/results/trajectory_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class LoadFrameTest : public ::testing::Test {
 protected:
  LoadFrameTest() {
    camera_.width = 64;
    camera_.height = 48;
  }
  ImageInput Load(const cv::Size& rgb, const cv::Size& depth) {
    const FramePaths paths{1.5, folder_.path() / "rgb.png", folder_.path() / "depth.png"};
    cv::imwrite(paths.image.string(), cv::Mat(rgb, CV_8UC3, cv::Scalar::all(9)));
    cv::imwrite(paths.depth.string(), cv::Mat(depth, CV_16UC1, cv::Scalar::all(999)));
    return LoadFrame(paths, camera_);
  }

  TemporaryFolder folder_;
  PinholeCamera camera_;
};

TEST_F(LoadFrameTest, DecodesBothImages) {
  const ImageInput image = Load({64, 48}, {64, 48});
  EXPECT_EQ(image.timestamp, 1.5);
  ASSERT_EQ(image.grey.type(), CV_8UC1);
  ASSERT_EQ(image.depth.type(), CV_16UC1);
  EXPECT_EQ(image.grey.at<uint8_t>(1, 2), 9);
  EXPECT_EQ(image.depth.at<uint16_t>(1, 2), 999);
}

TEST_F(LoadFrameTest, ImagesMustHaveTheSizeOfTheCamera) {
  ExpectInputError(
      [&] {
        Load({64, 48}, {32, 18});
      },
      {"depth.png: 32x18 px", "expected the shape of its colour image rgb.png, 64x48"});
  EXPECT_EQ(Load({64, 48}, {32, 24}).depth.size(), cv::Size(32, 24)) << "as read";
  ExpectInputError(
      [&] {
        Load({32, 24}, {32, 24});
      },
      {"rgb.png: 32x24 px", "Camera.width x Camera.height, 64x48"});
}

TEST_F(LoadFrameTest, DepthIsOptional) {
  const std::string image = folder_.path() / "grey.png";
  cv::imwrite(image, cv::Mat(48, 64, CV_8UC1, cv::Scalar::all(7)));
  const ImageInput input = LoadFrame({2.5, image}, camera_);
  EXPECT_EQ(input.timestamp, 2.5);
  EXPECT_EQ(input.grey.at<uint8_t>(0, 0), 7);
  EXPECT_TRUE(input.depth.empty());
}

TEST(ReadGroundtruth, ConvertedPosesReplaceTheFile) {
  const TemporaryFolder folder;
  ImageSequence sequence;
  EXPECT_FALSE(ReadGroundtruth(sequence).has_value());
  sequence.groundtruth = folder.Write("groundtruth.txt", "7 1 2 3 0 0 0 1\n");
  EXPECT_EQ(ReadGroundtruth(sequence).value().at(0).timestamp, 7.0);
  sequence.converted_groundtruth = Trajectory{{.timestamp = 0.5, .world_from_cam = {}}};
  EXPECT_EQ(ReadGroundtruth(sequence).value().at(0).timestamp, 0.5);
  sequence.converted_groundtruth.reset();
  sequence.groundtruth = folder.path() / "none.txt";
  ExpectInputError([&] { ReadGroundtruth(sequence); }, {"none.txt", "No such file"});
}

TEST(TryGroundtruth, WarnsOfAFileThatCannotBeUsed) {
  const TemporaryFolder folder;
  ImageSequence sequence;
  std::vector<std::string> warnings;
  EXPECT_FALSE(TryGroundtruth(sequence, warnings).has_value());
  sequence.groundtruth = folder.Write("groundtruth.txt", "7 1 2 3 0 0 0 1\n");
  EXPECT_TRUE(TryGroundtruth(sequence, warnings).has_value());
  EXPECT_TRUE(warnings.empty());
  sequence.groundtruth = folder.path() / "none.txt";
  EXPECT_FALSE(TryGroundtruth(sequence, warnings).has_value());
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].ends_with("; the run goes on without ground truth")) << warnings[0];
}

TEST(StampsOf, AreThoseOfTheFrames) {
  ImageSequence sequence;
  sequence.frames = {{1.5, "a.png"}, {2.5, "b.png"}};
  EXPECT_EQ(StampsOf(sequence.frames), (std::vector<double>{1.5, 2.5}));
}

TEST(AddWarp, StepsAreDoneInTheirOrder) {
  ImageSequence sequence;
  const auto add = [&](const Eigen::Vector3d& axis, double scale, double offset, cv::Size before) {
    AddWarp({.image = [=](const cv::Mat& image, ImageSide,
                          bool) { return cv::Mat(scale * image + cv::Scalar::all(offset)); },
             .pixel = [=](const Eigen::Vector2d& pixel,
                          ImageSide) { return Eigen::Vector2d(scale * pixel.array() + offset); },
             .after_from_before =
                 Rigid3(Eigen::Quaterniond(Eigen::AngleAxisd(0.3, axis)), Eigen::Vector3d::Zero()),
             .size_before = before},
            sequence);
  };
  const PinholeCamera camera{.width = 64, .height = 48};
  sequence.load = [](const FramePaths&, const PinholeCamera& read) {
    ImageInput image;
    image.grey = cv::Mat(read.height, read.width, CV_8UC1, cv::Scalar(5));
    return image;
  };
  add(Eigen::Vector3d::UnitX(), 1.0, 3.0, {32, 24});
  add(Eigen::Vector3d::UnitZ(), 2.0, 0.0, {});
  EXPECT_EQ(SizeAsRead(sequence, camera), cv::Size(32, 24));
  const ImageInput image = sequence.load({}, camera);
  EXPECT_EQ(image.grey.size(), cv::Size(32, 24)) << "the loader reads images of this size";
  EXPECT_EQ(image.grey.at<uint8_t>(0, 0), 16);
  EXPECT_TRUE(image.depth.empty());
  std::vector<InstanceMask> masks(1);
  masks[0].outlines = {{{5.0, 1.0}}};
  FitMasks(sequence.warps, ImageSide::kRight, masks);
  EXPECT_EQ(masks[0].outlines[0][0], Eigen::Vector2d(16.0, 8.0));
  const Eigen::Quaterniond turn =
      sequence.warps[1].after_from_before->rotation * sequence.warps[0].after_from_before->rotation;
  const Trajectory read = AsRead(sequence, {{1.0, Rigid3()}});
  EXPECT_LT(read[0].world_from_cam.rotation.angularDistance(turn), 1e-12);
  EXPECT_LT(AsLoaded(sequence, read)[0].world_from_cam.rotation.angularDistance(
                Eigen::Quaterniond::Identity()),
            1e-7);
}

TEST(ParseFrameRange, AMissingNumberIsAnEndOfTheSequence) {
  const auto ends = [](const char* text) {
    const FrameSelection range = ParseFrameRange("--frames", text, 10);
    EXPECT_EQ(range.stride, 1U);
    return std::pair(range.first, range.last);
  };
  EXPECT_EQ(ends(":"), std::pair(size_t{0}, size_t{9}));
  EXPECT_EQ(ends("3:"), std::pair(size_t{3}, size_t{9}));
  EXPECT_EQ(ends(":4"), std::pair(size_t{0}, size_t{4}));
  EXPECT_EQ(ends("5:5"), std::pair(size_t{5}, size_t{5}));
  for (const char* const text : {"", "3", "5:4", "0:10", "-1:3", "1:2:3", "a:b", "1: 2"}) {
    ExpectInputError([&] { ParseFrameRange("--frames", text, 10); },
                     {"--frames: '" + std::string(text) + "', expected FIRST:LAST"});
  }
}

TEST(ReadOdometry, StampsMustBeThoseOfTheImages) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "wheels.txt";
  WriteTrajectory(file, {{10.0, Rigid3()}, {10.1, Rigid3()}});
  ImageSequence sequence;
  sequence.frames = {{9.5, {}, {}}, {10.05, {}, {}}};
  ReadOdometry(file, SensorKind::kRgbd, sequence);
  ASSERT_EQ(sequence.warnings.size(), 1U);
  EXPECT_TRUE(sequence.warnings[0].ends_with("1 of 2 images have no odometry"));
  sequence.frames.pop_back();
  ExpectInputError([&] { ReadOdometry(file, SensorKind::kRgbd, sequence); },
                   {"wheels.txt: its stamps go from 10.000 to 10.100 s, expected those of the "
                    "images, 9.500 to 9.500"});
  ExpectInputError([&] { ReadOdometry(file, SensorKind::kMonocular, sequence); }, {"in metres"});
}

TEST(ReadOdometry, RefusesBadLinesByTheirNumbers) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "wheels.txt";
  const auto refuses = [&](const std::string& line, const std::string& fault) {
    std::ofstream(file) << "9.4 0 0 0 0 0 0 1\n" << line << "\n9.6 0 0 0 0 0 0 1\n";
    ImageSequence sequence;
    sequence.frames = {{9.5, {}, {}}};
    ExpectInputError([&] { ReadOdometry(file, SensorKind::kStereo, sequence); }, {fault});
  };
  refuses("9.5 0 nan 0 0 0 0 1", "wheels.txt:2: ty is 'nan', expected a finite number");
  refuses("9.3 0 0 0 0 0 0 1", "wheels.txt:2: time stamp 9.300000 is before");
  refuses("9.5 0 0 0 0 0 0 0", "wheels.txt:2: the quaternion has length 0");
  refuses("9.5 0 0 0 0 0 1", "wheels.txt:2: 7 columns, expected 8");
}

TEST(ImageSequence, GivesTheMotionBetweenTwoStamps) {
  ImageSequence sequence;
  Trajectory& odometry = sequence.odometry.emplace();
  for (int i = 0; i < 3; ++i) {
    odometry.push_back({0.1 * i, Rigid3(ExpSo3({0.0, 0.0, 0.5 * i}), {1.0 * i, 0.0, 0.0})});
  }
  const OdometryOptions options;
  const std::optional<MotionPrior> motion = PriorBetween(sequence, 0.0, 0.1, options);
  ASSERT_TRUE(motion.has_value());
  EXPECT_EQ(motion->last_timestamp, 0.0);
  const Rigid3 expected = Inverse(odometry[1].world_from_cam);
  EXPECT_LT((motion->cam_from_last_cam.translation - expected.translation).norm(), 1e-12);
  EXPECT_NEAR(motion->covariance(0, 0), 0.01 * 0.01, 1e-12) << "2 % of 0.5 rad";
  EXPECT_NEAR(motion->covariance(5, 5), 0.02 * 0.02, 1e-12) << "2 % of 1 m";
  const std::optional<MotionPrior> rest = PriorBetween(sequence, 0.1, 0.1, options);
  EXPECT_NEAR(rest->covariance(0, 0), 1e-8, 1e-15);
  EXPECT_NEAR(rest->covariance(5, 5), 1e-8, 1e-15);
  EXPECT_FALSE(PriorBetween(sequence, 0.1, 0.3, options).has_value());
}

}  // namespace
}  // namespace hullslam
