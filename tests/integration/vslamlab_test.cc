// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "geometry/mirror.h"
#include "hullslam/results/trajectory_file.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// A rendered sequence with the files of VSLAM-LAB beside it.
class VslamlabTest : public ::testing::Test {
 protected:
  explicit VslamlabTest(int frames = 20) : desk_(frames) { WriteFiles(1.0); }

  // `y` is the sign of fy in the calibration.
  void WriteFiles(double y) const {
    const ImageSequence images = OpenTumSequence(desk_.path(), {});
    std::ostringstream list;
    list << "ts_rgb_0 (ns),path_rgb_0,ts_depth_0 (ns),path_depth_0\n";
    for (size_t i = 0; i < images.frames.size(); ++i) {
      list << Stamp(i) << ",rgb/" << images.frames[i].image.filename().string() << ',' << Stamp(i)
           << ",depth/" << images.frames[i].depth.filename().string() << '\n';
    }
    folder_.Write("rgb.csv", list.str());
    const PinholeCamera camera = desk_.camera();
    std::ostringstream calibration;
    calibration << "cameras:\n- {cam_name: rgb_0, cam_model: pinhole, focal_length: [" << camera.fx
                << ", " << y * camera.fy << "], principal_point: [" << camera.cx << ", "
                << camera.cy << "], image_dimension: [" << camera.width << ", " << camera.height
                << "], fps: 30.0, depth_name: depth_0, depth_factor: 5000}\n";
    folder_.Write("calibration.yaml", calibration.str());
  }
  static int64_t Stamp(size_t i) {
    return 1305031102175304031 + static_cast<int64_t>(i) * 33333333;
  }

  std::vector<std::string> Arguments(const std::string& id) const {
    return {"sequence_path:" + desk_.path().string(),
            "calibration_yaml:" + Path("calibration.yaml"),
            "rgb_csv:" + Path("rgb.csv"),
            "exp_folder:" + Path("exp"),
            "exp_id:" + id,
            "verbose:0"};
  }
  std::string Path(const std::string& name) const { return folder_.path() / name; }
  // The lines of the result: stamp and seven numbers.
  std::vector<std::vector<double>> ReadResult(const std::string& name) const {
    std::ifstream in(Path("exp/" + name + "_KeyFrameTrajectory.csv"));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "ts (ns),tx (m),ty (m),tz (m),qx,qy,qz,qw");
    std::vector<std::vector<double>> rows;
    while (std::getline(in, line)) {
      std::istringstream cells(line);
      rows.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');) {
        rows.back().push_back(std::stod(cell));
      }
    }
    return rows;
  }
  void ExpectRefused(std::vector<std::string> arguments, const std::string& part) const {
    const ProgramResult result = RunProgram("vslamlab_hullslam_rgbd", std::move(arguments));
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
  }

  RenderedDesk desk_;
  TemporaryFolder folder_;
};

TEST_F(VslamlabTest, WritesTheKeyframesWithTheStampsOfTheList) {
  const ProgramResult result = RunProgram("vslamlab_hullslam_rgbd", Arguments("7"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.output.empty());
  const Trajectory keyframes = ReadTrajectory(Path("exp/7_hullslam/keyframes.txt"));
  const auto rows = ReadResult("7");
  ASSERT_EQ(rows.size(), keyframes.size());
  const std::string text = ReadFile(Path("exp/7_KeyFrameTrajectory.csv"));
  EXPECT_NE(text.find("\n1305031102175304031,"), std::string::npos);
  EXPECT_EQ(ReadFile(Path("exp/00007_KeyFrameTrajectory.csv")), text);
  EXPECT_NEAR(rows.back()[1], keyframes.back().world_from_cam.translation.x(), 1e-6);
  EXPECT_NEAR(rows.back()[7], keyframes.back().world_from_cam.rotation.w(), 1e-6);
}

TEST_F(VslamlabTest, ANegativeFocalLengthMirrorsThePoses) {
  WriteFiles(-1.0);
  ASSERT_EQ(RunProgram("vslamlab_hullslam_rgbd", Arguments("00001")).exit_code, 0);
  const Trajectory keyframes = ReadTrajectory(Path("exp/00001_hullslam/keyframes.txt"));
  const auto rows = ReadResult("00001");
  const Rigid3 mirrored = MirrorY(keyframes.back().world_from_cam);
  EXPECT_NEAR(rows.back()[2], mirrored.translation.y(), 1e-6);
  EXPECT_NEAR(rows.back()[2], -keyframes.back().world_from_cam.translation.y(), 1e-6);
  const Eigen::Quaterniond rotation(rows.back()[7], rows.back()[4], rows.back()[5], rows.back()[6]);
  EXPECT_LT(rotation.angularDistance(mirrored.rotation), 1e-6);
}

TEST_F(VslamlabTest, SettingsOfTheBaselineAreThoseOfHullslam) {
  std::vector<std::string> arguments = Arguments("1");
  arguments.push_back("settings_yaml:" + folder_
                                             .Write("settings.yaml",
                                                    "%YAML:1.0\ncam_mono: rgb_0\ncam_rgbd: rgb_0\n"
                                                    "ORBextractor.nFeatures: 700\n")
                                             .string());
  arguments.emplace_back("mode:rgbd");
  arguments.emplace_back("verbose:1");
  const ProgramResult result = RunProgram("vslamlab_hullslam_rgbd", arguments);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("up to 700 features"), std::string::npos) << result.output;
}

class VslamlabInputTest : public VslamlabTest {
 protected:
  VslamlabInputTest() : VslamlabTest(2) {}
};

TEST_F(VslamlabInputTest, IsRefused) {
  ExpectRefused({"zebra:1"}, "'zebra:1'");
  ExpectRefused({"sequence_path"}, "expected key:value");
  std::vector<std::string> missing = Arguments("1");
  missing.erase(missing.begin() + 2);
  ExpectRefused(missing, "rgb_csv: is not given");
  const auto with = [&](const std::string& word) {
    std::vector<std::string> arguments = Arguments("1");
    arguments.push_back(word);
    return arguments;
  };
  ExpectRefused(with("mode:mono"), "mode is 'mono'");
  ExpectRefused(with("verbose:2"), "verbose is '2'");
  ExpectRefused(with("seed:-1"), "seed is '-1'");
  ExpectRefused(with("exp_id:a/b"), "exp_id is 'a/b'");
  ExpectRefused(with("preset:zebra"), "zebra");
  ExpectRefused(with("settings_yaml:" + Path("none.yaml")), "none.yaml");
  EXPECT_FALSE(std::filesystem::exists(Path("exp")));
}

}  // namespace
}  // namespace hullslam
