// SPDX-License-Identifier: GPL-3.0-or-later
// The examples of the library in C++. tests/python/examples_test.py compares those in Python with
// them.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "hullslam/map_files/map_file.h"
#include "hullslam/results/trajectory_file.h"
#include "support/made_network.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// Two sequences of the desk: with depth, and of a stereo camera.
class LibraryExamples : public ::testing::Test {
 protected:
  static std::string Render(const char* name, const std::vector<std::string>& options) {
    static const TemporaryFolder folder;
    const std::string desk = folder.path() / name;
    if (!std::filesystem::exists(desk)) {
      std::vector<std::string> arguments = {desk, "--quiet"};
      arguments.insert(arguments.end(), options.begin(), options.end());
      EXPECT_EQ(RunProgram("make_synthetic", arguments).exit_code, 0);
    }
    return desk;
  }
  static std::string Desk() { return Render("desk", {"--frames", "60"}); }

  // The lines that an example prints.
  static std::vector<std::string> LinesOf(const std::string& example,
                                          const std::vector<std::string>& arguments) {
    const ProgramResult result = RunProgram(example, arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    std::istringstream stream(result.output);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
      lines.push_back(line);
    }
    EXPECT_FALSE(lines.empty());
    return lines;
  }
  static ptrdiff_t CountObjects(const std::vector<std::string>& lines) {
    return std::ranges::count_if(
        lines, [](const std::string& line) { return line.find(" at ") != std::string::npos; });
  }

  const TemporaryFolder folder_;
};

// The camera of the example moves to the right by 1 cm per frame, at 30 frames per second.
TEST_F(LibraryExamples, MinimalPrintsOnePosePerFrame) {
  const std::vector<std::string> lines = LinesOf("01_minimal", {});
  ASSERT_EQ(lines.size(), 20U);
  for (size_t i = 0; i < lines.size(); ++i) {
    double stamp = 0.0;
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    ASSERT_EQ(std::sscanf(lines[i].c_str(), "%lf s: %lf %lf %lf m", &stamp, &x, &y, &z), 4);
    EXPECT_NEAR(stamp, static_cast<double>(i) / 30.0, 1e-3);
    EXPECT_NEAR(x, 0.01 * static_cast<double>(i), 0.003) << lines[i];
    EXPECT_NEAR(y, 0.0, 0.003) << lines[i];
    EXPECT_NEAR(z, 0.0, 0.003) << lines[i];
  }
}

TEST_F(LibraryExamples, ObjectsAreMappedWithDepthAndMasks) {
  const std::string output = folder_.path() / "trajectory.txt";
  const std::vector<std::string> lines =
      LinesOf("02_rgbd_with_masks", {Desk(), Desk() + "/masks", output});
  EXPECT_EQ(lines.front(), "60 of 60 frames have a pose");
  EXPECT_TRUE(std::filesystem::exists(output));
  EXPECT_GE(CountObjects(lines), 3);
  double error = 1.0;
  ASSERT_EQ(std::sscanf(lines.back().c_str(), "error %lf m over 60 poses", &error), 1)
      << lines.back();
  EXPECT_LT(error, 0.01);
}

TEST_F(LibraryExamples, AllPairsOfAStereoCameraHaveAPose) {
  const std::string pairs = Render("pairs", {"--frames", "12", "--stereo", "0.1"});
  EXPECT_EQ(LinesOf("03_stereo", {pairs}).size(), 12U);
}

// The network finds red things, so a red thing is painted into all images.
TEST_F(LibraryExamples, MasksOfANetworkAreAddedLate) {
  const std::string painted = Render("painted", {"--frames", "12"});
  for (const auto& file : std::filesystem::directory_iterator(painted + "/rgb")) {
    cv::Mat image = cv::imread(file.path());
    PaintBlob({180, 180, 120, 120}, true, image);
    cv::imwrite(file.path(), image);
  }
  const std::string network = folder_.Write("red.onnx", MadeNetwork{}.Bytes());
  const std::vector<std::string> lines = LinesOf("04_late_masks", {painted, network});
  EXPECT_EQ(lines.at(0), "12 of 12 frames have a pose");
  int detections = 0;
  ASSERT_EQ(std::sscanf(lines.at(1).c_str(), "%d detections of objects", &detections), 1);
  EXPECT_GT(detections, 0);
}

TEST_F(LibraryExamples, ObjectsAreMappedWithKnownPoses) {
  const std::vector<std::string> lines = LinesOf("05_known_poses", {Desk(), Desk() + "/masks"});
  EXPECT_EQ(lines.front(), "12 views");
  EXPECT_GE(CountObjects(lines), 3);
}

TEST_F(LibraryExamples, TheSecondHalfIsFoundInTheMapOfTheFirst) {
  const std::vector<std::string> lines =
      LinesOf("06_localisation", {Desk(), folder_.path() / "desk.map"});
  EXPECT_TRUE(lines.back().starts_with("30 of 30 frames found in a map of ")) << lines.back();
  EXPECT_EQ(lines.size(), 31U);
}

// With the true poses as those of the wheels. The odometry has then no drift to speak of.
TEST_F(LibraryExamples, ARobotCrossesACoveredLens) {
  const std::filesystem::path map = folder_.path() / "desk.map";
  const std::vector<std::string> lines =
      LinesOf("07_robot", {Desk(), Desk() + "/groundtruth.txt", map});
  ASSERT_GE(lines.size(), 3U);
  EXPECT_EQ(lines[lines.size() - 3], "10 frames by wheels alone");
  Eigen::Vector3d odometry;
  ASSERT_EQ(std::sscanf(lines[lines.size() - 2].c_str(), "odometry: %lf %lf %lf m", &odometry.x(),
                        &odometry.y(), &odometry.z()),
            3);
  Eigen::Vector3d in_map;
  ASSERT_EQ(std::sscanf(lines.back().c_str(), "map: %lf %lf %lf m", &in_map.x(), &in_map.y(),
                        &in_map.z()),
            3);
  EXPECT_LT((odometry - in_map).norm(), 0.05);
  EXPECT_TRUE(std::filesystem::exists(map));
}

// A base that stands at another place and looks along x, as those of robots do. The true poses are
// also those of the wheels, and five images are black.
TEST_F(LibraryExamples, ANodeOfRosPublishesTheTransformsOfABase) {
  const std::filesystem::path map = folder_.path() / "desk.map";
  const std::vector<std::string> lines =
      LinesOf("stubbed_hullslam_node",
              {Desk(), "odometry", "map:=" + map.string(), "realtime:=false", "base_frame:=base",
               "camera_in_base:=0.2 0.1 0.5 -0.5 0.5 -0.5 0.5"});
  const Trajectory truth = ReadTrajectory(Desk() + "/groundtruth.txt");
  const Rigid3 base_from_cam(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.2, 0.1, 0.5});
  std::map<std::string, std::vector<Rigid3>> poses;
  std::vector<std::array<double, 3>> rest;  // variances, velocity
  for (const std::string& line : lines) {
    std::istringstream stream(line);
    std::string topic;
    std::string parent;
    std::string child;
    double stamp = 0.0;
    Eigen::Vector3d position;
    Eigen::Vector4d rotation;
    stream >> topic >> parent >> child >> stamp;
    if (!stream) {
      EXPECT_TRUE(line.starts_with("events ")) << line;
      continue;
    }
    for (double& number : position) {
      stream >> number;
    }
    for (double& number : rotation) {
      stream >> number;
    }
    auto& of_frames = poses[topic + " " + parent + " " + child];
    EXPECT_NEAR(stamp, truth.at(of_frames.size()).timestamp, 1e-6) << line;
    of_frames.emplace_back(Eigen::Quaterniond(rotation), position);
    if (topic == "visual_odometry") {
      auto& [x, turn, speed] = rest.emplace_back();
      stream >> x >> turn >> speed;
    }
    EXPECT_TRUE(stream) << line;
  }
  const std::vector<Rigid3>& map_from_odom = poses["tf map odom"];
  const std::vector<Rigid3>& odom_from_base = poses["tf odom base"];
  ASSERT_EQ(poses.size(), 3U);
  ASSERT_EQ(map_from_odom.size(), truth.size());
  ASSERT_EQ(odom_from_base.size(), truth.size());
  ASSERT_EQ(poses["visual_odometry odom base"].size(), truth.size());
  const auto true_base = [&](size_t i) {
    return base_from_cam * Inverse(truth[0].world_from_cam) * truth[i].world_from_cam *
           Inverse(base_from_cam);
  };
  for (size_t i = 0; i < truth.size(); ++i) {
    const Rigid3 expected = true_base(i);
    const Rigid3 found = map_from_odom[i] * odom_from_base[i];
    EXPECT_LT((found.translation - expected.translation).norm(), 0.005) << i;
    EXPECT_LT(AngularDistance(found.rotation, expected.rotation), 0.005) << i;
    EXPECT_EQ(poses["visual_odometry odom base"][i].translation, odom_from_base[i].translation);
    if (i > 0) {
      const Rigid3 step = Inverse(true_base(i - 1)) * expected;
      const double seconds = truth[i].timestamp - truth[i - 1].timestamp;
      EXPECT_NEAR(rest[i][2], step.translation.x() / seconds, 0.02) << i;
      EXPECT_GT(rest[i][0], 0.0) << i;
      EXPECT_LT(rest[i][1], 1e-3) << i;
    }
  }
  EXPECT_GE(ReadMap(map).map.keyframes().size(), 1U);
  const std::vector<std::string> again =
      LinesOf("stubbed_hullslam_node",
              {Desk(), "map:=" + map.string(), "realtime:=false", "localization_only:=true"});
  EXPECT_GE(again.size(), 3U * 50U);
}

TEST_F(LibraryExamples, BadUsageAndInputAreRefused) {
  EXPECT_EQ(RunProgram("03_stereo", {}).exit_code, 2);
  const ProgramResult result = RunProgram("05_known_poses", {"none", "none"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(result.errors.starts_with("error: none: ")) << result.errors;
}

}  // namespace
}  // namespace hullslam
