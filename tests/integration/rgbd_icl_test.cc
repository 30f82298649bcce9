// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "hullslam/results/trajectory_file.h"
#include "support/made_room.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

constexpr int kRgbdIclFrames = 16;
constexpr double kRgbdIclSmall = 0.004;  // m

class RgbdIcl : public ::testing::Test {
 protected:
  ProgramResult Run(Arguments arguments) const {
    arguments.insert(arguments.end(), {"--output", output_});
    return RunProgram("rgbd_icl", arguments);
  }
  ProgramResult RunWell(const Arguments& arguments) const {
    ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result;
  }
  void ExpectRefusal(const Arguments& arguments, const std::vector<std::string>& parts) const {
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    for (const std::string& part : parts) {
      EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
    }
    EXPECT_FALSE(fs::exists(output_));
  }
  Json Trajectory() const { return Json::parse(ReadFile(output_ / "summary.json"))["trajectory"]; }
  void ExpectSmallError(int pairs) const {
    EXPECT_EQ(Trajectory()["tracked"], kRgbdIclFrames);
    EXPECT_EQ(Trajectory()["pairs"], pairs);
    EXPECT_LT(Trajectory()["ate_rmse_m"].get<double>(), kRgbdIclSmall);
  }

  TemporaryFolder folder_;
  std::string path_ = folder_.path() / "sequence";
  fs::path output_ = folder_.path() / "out";
  MadeRoom room_;
};

TEST_F(RgbdIcl, AGroundTruthWithEitherAxisFitsTheTrajectory) {
  for (const bool is_up : {true, false}) {
    room_.WriteIclTum(path_, kRgbdIclFrames, is_up);
    const ProgramResult result = RunWell({path_});
    EXPECT_NE(result.output.find(is_up ? "y up, mirrored" : "y down"), std::string::npos);
    ExpectSmallError(kRgbdIclFrames - 1);  // the first frame has no true pose
  }
}

// A mirrored trajectory does not fit. This shows that the other tests can notice a wrong axis.
TEST_F(RgbdIcl, TheWrongAxisGivesALargeError) {
  room_.WriteIclTum(path_, 2 * kRgbdIclFrames, true);
  RunWell({path_, "--quiet"});
  const double right = Trajectory()["ate_rmse_m"];
  const ProgramResult result = RunWell({path_, "--groundtruth-y", "down"});
  EXPECT_NE(result.output.find("as --groundtruth-y says"), std::string::npos) << result.output;
  EXPECT_GT(Trajectory()["ate_rmse_m"].get<double>(), 3.0 * right) << right;
}

TEST_F(RgbdIcl, TheConvertedGroundTruthIsWrittenForOtherPrograms) {
  room_.WriteIclTum(path_, kRgbdIclFrames, true);
  const ProgramResult quiet = RunWell({path_, "--quiet"});
  EXPECT_EQ(quiet.output + quiet.errors, "");
  const ProgramResult result =
      RunProgram("hullslam evaluate",
                 {"trajectory", output_ / "groundtruth.txt", output_ / "trajectory.txt", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_LT(ReadTrajectory(output_ / "groundtruth.txt").back().timestamp, 1.0);
  const Json summary = Json::parse(ReadFile(output_ / "summary.json"));
  const Json files = summary["files"];
  EXPECT_NE(std::find(files.begin(), files.end(), "groundtruth.txt"), files.end());
  fs::remove(fs::path(path_) / "made.gt.freiburg");
  RunWell({path_, "--quiet"});
  EXPECT_FALSE(fs::exists(output_ / "groundtruth.txt"));
}

// The fourth argument is the association file. The settings have fy = -480, as in other programs.
TEST_F(RgbdIcl, TakesTheFourArgumentsOfOrbSlam2) {
  room_.WriteIclTum(path_, kRgbdIclFrames, true);
  const std::string settings = folder_.Write(
      "ICL.yaml",
      "%YAML:1.0\nCamera.fx: 481.2\nCamera.fy: -480.0\nCamera.cx: 319.5\nCamera.cy: 239.5\n");
  fs::rename(fs::path(path_) / "associations.txt", folder_.path() / "pairs.txt");
  RunWell({"none", settings, path_, folder_.path() / "pairs.txt"});
  ExpectSmallError(kRgbdIclFrames - 1);
  const ProgramResult tum = RunProgram("rgbd_tum", {"none", settings, path_, "none.txt"});
  EXPECT_EQ(tum.exit_code, 2);
}

TEST_F(RgbdIcl, WrongArgumentsAreRefused) {
  fs::create_directory(path_);
  ExpectRefusal({path_}, {path_, "associations.txt", "No such file"});
  ExpectRefusal({path_ + "/none"}, {path_ + "/none: no such folder"});
  ExpectRefusal({path_, "--groundtruth-y", "left"}, {"--groundtruth-y", "left"});
}

}  // namespace
}  // namespace hullslam
