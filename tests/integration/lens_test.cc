// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "hullslam/results/trajectory_file.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 30;

class Lens : public ::testing::Test {
 protected:
  // The summary of a run of rgbd_tum over a desk with its masks.
  nlohmann::json Run(const fs::path& desk, const std::string& name,
                     std::vector<std::string> options) {
    std::vector<std::string> arguments = {desk, "--masks", desk / "masks", "--output",
                                          folder_.path() / name};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramResult result = RunProgram("rgbd_tum", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    output_ = result.output;
    return nlohmann::json::parse(ReadText(folder_.path() / name / "summary.json"));
  }

  TemporaryFolder folder_;
  std::string output_;
};

// The series of tan(t) makes a Kannala-Brandt lens of the pinhole with which the desk is rendered.
TEST_F(Lens, APinholeAsFisheyeGivesTheSameTrajectory) {
  const RenderedDesk desk(kFrames);
  Run(desk.path(), "pinhole", {});
  Run(desk.path(), "fisheye",
      {"--set", "Camera.type=KannalaBrandt8", "--set", "Camera.k1=0.333333333", "--set",
       "Camera.k2=0.133333333", "--set", "Camera.k3=0.0539682540", "--set",
       "Camera.k4=0.0218694885"});
  EXPECT_NE(output_.find("camera: 640x480 px, with a fisheye lens"), std::string::npos) << output_;
  const Trajectory pinhole = ReadTrajectory(folder_.path() / "pinhole/trajectory.txt");
  const Trajectory fisheye = ReadTrajectory(folder_.path() / "fisheye/trajectory.txt");
  ASSERT_EQ(pinhole.size(), static_cast<size_t>(kFrames));
  ASSERT_EQ(fisheye.size(), pinhole.size());
  for (size_t i = 0; i < pinhole.size(); ++i) {
    const Rigid3 difference = pinhole[i].world_from_cam * Inverse(fisheye[i].world_from_cam);
    EXPECT_LT(
        (pinhole[i].world_from_cam.translation - fisheye[i].world_from_cam.translation).norm(),
        0.002)
        << i;
    EXPECT_LT(LogSo3(difference.rotation).norm(), 0.001) << i;
  }
}

TEST_F(Lens, ADeskThroughAFisheyeIsTrackedWithItsObjects) {
  const fs::path desk = folder_.path() / "desk";
  const ProgramResult rendered = RunProgram(
      "make_synthetic", {desk, "--frames", std::to_string(kFrames), "--fisheye", "160", "--quiet"});
  ASSERT_EQ(rendered.exit_code, 0) << rendered.errors;
  const nlohmann::json summary = Run(desk, "out", {"--quiet"});
  EXPECT_EQ(summary["trajectory"]["tracked"], kFrames);
  EXPECT_LT(summary["trajectory"]["ate_rmse_m"].get<double>(), 0.003);
  EXPECT_GE(summary["objects"]["count"].get<int>(), 8);
  EXPECT_GT(summary["objects"]["siou_mean"].get<double>(), 0.75);
  EXPECT_EQ(RunProgram("make_synthetic", {folder_.path() / "x", "--fisheye", "300"}).exit_code, 2);
}

// The lens of 160 degrees above, fitted to 0.01 px by two other models.
TEST_F(Lens, OtherModelsOfTheSameLensGiveItsTrajectory) {
  const fs::path desk = folder_.path() / "desk";
  const ProgramResult rendered = RunProgram(
      "make_synthetic", {desk, "--frames", std::to_string(kFrames), "--fisheye", "160", "--quiet"});
  ASSERT_EQ(rendered.exit_code, 0) << rendered.errors;
  struct Model {
    const char* type;
    const char* focal;
    std::vector<std::string> coefficients;
  };
  const std::vector<Model> models = {
      {"DoubleSphere", "229.724793", {"Camera.xi=-0.172414", "Camera.alpha=0.593623"}},
      {"EUCM", "229.689283", {"Camera.alpha=0.629196", "Camera.beta=1.043956"}}};
  for (const Model& model : models) {
    std::vector<std::string> options = {"--quiet"};
    std::vector<std::string> settings = model.coefficients;
    settings.insert(settings.end(), {"Camera.k1=0", "Camera.k2=0", "Camera.k3=0", "Camera.k4=0",
                                     "Camera.type=" + std::string(model.type),
                                     "Camera.fx=" + std::string(model.focal),
                                     "Camera.fy=" + std::string(model.focal)});
    for (const std::string& setting : settings) {
      options.insert(options.end(), {"--set", setting});
    }
    const nlohmann::json summary = Run(desk, model.type, options);
    EXPECT_EQ(summary["trajectory"]["tracked"], kFrames) << model.type;
    EXPECT_LT(summary["trajectory"]["ate_rmse_m"].get<double>(), 0.004) << model.type;
    EXPECT_GE(summary["objects"]["count"].get<int>(), 8) << model.type;
    EXPECT_GT(summary["objects"]["siou_mean"].get<double>(), 0.75) << model.type;
  }
}

TEST_F(Lens, APairOfFisheyeLensesIsRectifiedAndTracked) {
  constexpr int kPairs = 12;
  const fs::path desk = folder_.path() / "pairs";
  const ProgramResult rendered =
      RunProgram("make_synthetic", {desk, "--frames", std::to_string(kPairs), "--fisheye", "120",
                                    "--stereo", "0.12", "--quiet"});
  ASSERT_EQ(rendered.exit_code, 0) << rendered.errors;
  const ProgramResult result = RunProgram(
      "stereo_folder", {desk, "--masks", desk / "masks", "--output", folder_.path() / "out"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("stereo: baseline 0.1200 m"), std::string::npos) << result.output;
  const auto summary = nlohmann::json::parse(ReadText(folder_.path() / "out/summary.json"));
  EXPECT_EQ(summary["trajectory"]["tracked"], kPairs);
  EXPECT_LT(summary["trajectory"]["ate_rmse_m"].get<double>(), 0.003);
}

TEST_F(Lens, ImagesAndMasksAreResized) {
  const RenderedDesk desk(kFrames);
  const nlohmann::json summary = Run(desk.path(), "half", {"--set", "Camera.imageScale=0.75"});
  EXPECT_NE(output_.find("images are resized from 640x480"), std::string::npos) << output_;
  EXPECT_NE(output_.find("in each image of 480x360 px"), std::string::npos) << output_;
  EXPECT_EQ(summary["trajectory"]["tracked"], kFrames);
  EXPECT_LT(summary["trajectory"]["ate_rmse_m"].get<double>(), 0.004);
  EXPECT_GE(summary["objects"]["count"].get<int>(), 5);
  EXPECT_GT(summary["objects"]["siou_mean"].get<double>(), 0.7);
}

}  // namespace
}  // namespace hullslam
