// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "hullslam/results/trajectory_file.h"
#include "support/interrupted_desk.h"
#include "support/run_program.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// A camera with depth that sees nothing for more than a second, and then another place.
class RgbdIslands : public ::testing::Test {
 protected:
  static constexpr int kBlank = 36;

  // The summary of a run on the desk, with the exit code that is expected.
  nlohmann::json Run(const InterruptedDesk& desk, const std::vector<std::string>& more,
                     int exit_code) {
    std::vector<std::string> arguments = {desk.path(), "--output", output_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunProgram("rgbd_tum", arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    report_ = result.output;
    return nlohmann::json::parse(ReadFile(output_ / "summary.json"));
  }

  TemporaryFolder folder_;
  const fs::path output_ = folder_.path() / "out";
  std::string report_;
};

TEST_F(RgbdIslands, TheOtherPlaceIsJoinedWhenBothAreSeen) {
  const InterruptedDesk desk({.blank = kBlank, .has_depth = true});
  const nlohmann::json summary = Run(desk, {"--set", "run.max_lost_share=0.5"}, 0);
  EXPECT_EQ(summary["islands"]["begun"], 2);
  EXPECT_EQ(summary["islands"]["joined"], 1);
  EXPECT_EQ(summary["trajectory"]["tracked"], desk.size() - kBlank);
  EXPECT_LE(summary["trajectory"]["ate_rmse_m"].get<double>(), 0.005);
}

TEST_F(RgbdIslands, OnesThatAreNeverJoinedAreSummarisedAndKeptIfAskedFor) {
  const InterruptedDesk desk({.blank = kBlank, .shows_whole = false, .has_depth = true});
  const nlohmann::json without = Run(desk, {}, 1);
  ASSERT_EQ(without["islands"]["at_end"].size(), 2u);
  EXPECT_FALSE(fs::exists(output_ / "trajectory_island1.txt"));
  EXPECT_FALSE(fs::exists(output_ / "trajectory_island2.txt"));
  EXPECT_NE(report_.find("not joined to the map"), std::string::npos) << report_;

  const fs::path saved = folder_.path() / "desk.map";
  const nlohmann::json summary = Run(desk, {"--keep-islands", "--save-map", saved}, 1);
  const nlohmann::json& islands = summary["islands"]["at_end"];
  ASSERT_EQ(islands.size(), 2u);
  EXPECT_EQ(islands[0]["main"], true);
  EXPECT_EQ(islands[0]["frames"], summary["trajectory"]["tracked"]);
  EXPECT_EQ(islands[1]["main"], false);
  const std::string name = "_island" + std::to_string(islands[1]["number"].get<int>());
  const Trajectory trajectory = ReadTrajectory(output_ / ("trajectory" + name + ".txt"));
  EXPECT_EQ(trajectory.size(), islands[1]["frames"]);
  EXPECT_EQ(trajectory.front().timestamp, islands[1]["first_timestamp"]);
  EXPECT_GE(trajectory.size(), 25u);
  EXPECT_LE(islands[1]["ate_rmse_m"].get<double>(), 0.005);
  EXPECT_EQ(ReadTrajectory(output_ / ("keyframes" + name + ".txt")).size(),
            islands[1]["keyframes"]);
  EXPECT_TRUE(fs::exists(output_ / ("map" + name + ".ply")));
  EXPECT_TRUE(fs::exists(saved));
  // The island's map is one that a later run can load.
  const fs::path island = folder_.path() / ("desk" + name + ".map");
  const nlohmann::json found = Run(desk, {"--load-map", island, "--localization"}, 1);
  EXPECT_GE(found["trajectory"]["tracked"], 25);
}

// 82 keyframes of a phone, 0.1 to 0.5 m and up to 40 degrees apart. Each part of the map that
// begins where the camera is lost is joined, and lost frames are found at the end.
TEST_F(RgbdIslands, KeyframesOfAPhoneMakeOneMap) {
  const auto data = FindTestData("iphone_lidar_82");
  if (!data) {
    GTEST_SKIP() << "the keyframes of a phone are not on this machine";
  }
  const ProgramResult result = RunProgram("rgbd_tum", {*data, "--output", output_, "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const auto summary = nlohmann::json::parse(ReadFile(output_ / "summary.json"));
  EXPECT_GE(summary["trajectory"]["tracked"], 78);
}

}  // namespace
}  // namespace hullslam
