// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of rgbd_tum with masks: the files that they write, and which of these equal the files of a
// run without objects.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/text_rows.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::json;

class RgbdObjects : public ::testing::Test {
 protected:
  // Renders the first frames of a scene.
  void Render(const std::string& scene, int frames) const {
    const ProgramResult result =
        RunProgram("make_synthetic",
                   {sequence_, "--scene", scene, "--frames", std::to_string(frames), "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  // Runs the program, expects exit code 0 and returns the folder with the results.
  fs::path Run(const std::string& name, const std::vector<std::string>& more) const {
    const fs::path output = folder_.path() / name;
    std::vector<std::string> arguments = {sequence_, "--quiet", "--output", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunProgram("rgbd_tum", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return output;
  }

  static Json Summary(const fs::path& output) {
    return Json::parse(ReadFile(output / "summary.json"));
  }
  static void ExpectSameBytes(const fs::path& first, const fs::path& second,
                              const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      EXPECT_TRUE(ReadFile(first / file) == ReadFile(second / file)) << file;
    }
  }

  TemporaryFolder folder_;
  fs::path sequence_ = folder_.path() / "sequence";
  std::string masks_ = sequence_ / "masks";
};

TEST_F(RgbdObjects, AreWrittenWithTheSameBytesInEveryRun) {
  Render("desk", 60);
  const fs::path first = Run("first", {"--masks", masks_});
  EXPECT_TRUE(ReadFile(first / "objects.ply").starts_with("ply\n"));
  const Json summary = Summary(first);
  EXPECT_EQ(summary["trajectory"]["tracked"], 60);
  EXPECT_EQ(summary["objects"]["frames_with_masks"], 60);
  EXPECT_GE(summary["objects"]["count"], 5);
  EXPECT_GT(summary["objects"]["siou_mean"], 0.5);
  size_t mapped = 0;
  const Json objects = Json::parse(ReadFile(first / "objects.json"));
  for (const Json& object : objects["objects"]) {
    mapped += object["state"] == "mapped" ? 1 : 0;
  }
  EXPECT_EQ(summary["objects"]["count"], mapped);
  // The covariance of an ellipsoid says nothing about a thing that is a box.
  size_t keyboards = 0;
  for (const Json& object : objects["objects"]) {
    if (object["class"] == "keyboard" && object["state"] == "mapped") {
      ++keyboards;
      EXPECT_EQ(object["undetermined_axes"], Json::array());
    }
  }
  EXPECT_EQ(keyboards, 1);

  const fs::path second = Run("second", {"--masks", masks_});
  ExpectSameBytes(first, second,
                  {"trajectory.txt", "objects.json", "objects_observations.json", "objects.csv",
                   "objects.ply", "scene.json", "map.ply"});
}

TEST_F(RgbdObjects, SwitchedOffChangeNoOutput) {
  Render("desk", 40);
  const fs::path without = Run("without", {});
  EXPECT_FALSE(fs::exists(without / "objects.json"));
  const fs::path off = Run("off", {"--masks", masks_, "--set", "objects.enabled=0"});
  ExpectSameBytes(without, off, {"trajectory.txt", "keyframes.txt", "map.ply"});
}

TEST_F(RgbdObjects, AreMappedByThreads) {
  Render("desk", 60);
  const Json summary = Summary(Run("threaded", {"--masks", masks_, "--threaded"}));
  EXPECT_EQ(summary["provenance"]["pipeline"], "threaded");
  EXPECT_EQ(summary["trajectory"]["tracked"], 60);
  EXPECT_LE(summary["trajectory"]["ate_rmse_m"], 0.010);
  EXPECT_GE(summary["objects"]["count"], 3);
}

// A box of class person moves through the scene. Without its mask the estimated camera follows it,
// by 10 cm after 75 frames.
TEST_F(RgbdObjects, ThatMoveDoNotMoveTheCamera) {
  Render("dynamic", 75);
  const auto error = [&](const std::string& name, const std::vector<std::string>& more) {
    const Json trajectory = Summary(Run(name, more))["trajectory"];
    EXPECT_EQ(trajectory["tracked"], 75);
    return trajectory["ate_rmse_m"].get<double>();
  };
  const double without = error("without", {});
  const double with = error("with", {"--masks", masks_});
  EXPECT_LE(with, without / 3.0);
  fmt::print("ATE RMSE {:.2f} mm, without masks {:.2f} mm\n", 1e3 * with, 1e3 * without);
}

// If objects are used neither in tracking nor in bundle adjustment, only points determine the
// poses, so these do not change.
TEST_F(RgbdObjects, ThatAreOnlyMappedLeavePosesAlone) {
  Render("desk", 60);
  const std::vector<std::string> masks = {"--masks", masks_, "--set", "tracking.dynamic_classes="};
  const auto run = [&](const std::string& name, const std::vector<std::string>& settings) {
    std::vector<std::string> arguments = masks;
    for (const std::string& setting : settings) {
      arguments.insert(arguments.end(), {"--set", setting});
    }
    return Run(name, arguments);
  };
  const fs::path off = run("off", {"objects.enabled=0"});
  const fs::path mapped =
      run("mapped", {"objects.joint_pose=0", "objects.bundle_adjustment=0",
                     "objects.guided_matching=0", "tracking.keyframes_for_objects=0"});
  ExpectSameBytes(off, mapped, {"trajectory.txt", "keyframes.txt", "map.ply"});
  EXPECT_GE(Summary(mapped)["objects"]["count"], 3);
}

}  // namespace
}  // namespace hullslam
