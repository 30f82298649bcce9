// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hullslam/io/trajectory_file.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

Trajectory Curve(double scale) {
  Trajectory trajectory;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back(
        {t, Rigid3(ExpSo3({0.0, 0.0, t}), {scale * std::cos(t), scale * std::sin(t), scale * t})});
  }
  return trajectory;
}

class Evaluate : public ::testing::Test {
 protected:
  Evaluate() {
    WriteTrajectory(truth_, Curve(1.0));
    WriteTrajectory(half_, Curve(0.5));
  }

  // Bad input ends with code 2, nothing on stdout and one line that holds `part`.
  static void ExpectRefusal(const std::vector<std::string>& arguments, const std::string& part) {
    const ProgramResult result = RunProgram("evaluate", arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(result.errors.starts_with("error: ")) << result.errors;
    EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
  }

  TemporaryFolder folder_;
  std::string truth_ = folder_.path() / "truth.txt";
  std::string half_ = folder_.path() / "half.txt";
};

TEST_F(Evaluate, StatesErrorsPairsAlignmentAndScale) {
  const ProgramResult result =
      RunProgram("evaluate", {"trajectory", truth_, half_, "--align", "sim3"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  for (const char* const part :
       {"ATE", "RPE 1 s", "60 of the estimate", "60 of the ground truth",
        "tum's rule within 0.02 s", "coverage 100.0 %", "sim3", "scale 2.000000"}) {
    EXPECT_NE(result.output.find(part), std::string::npos) << part << " in\n" << result.output;
  }
}

TEST_F(Evaluate, JsonHoldsTheSame) {
  const ProgramResult result =
      RunProgram("evaluate", {"trajectory", truth_, half_, "--json", "--tool", "evo", "--align",
                              "none", "--max-diff", "0.05"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["pairs"], 60);
  EXPECT_EQ(json["pairing"], "evo");
  EXPECT_EQ(json["alignment"], "none");
  EXPECT_EQ(json["max_difference_s"], 0.05);
  EXPECT_EQ(json["coverage"], 1.0);
  // The last pose is the farthest: half of (cos t, sin t, t) at 5.9 s is missing.
  EXPECT_NEAR(json["ate_m"]["max"].get<double>(), 0.5 * std::hypot(1.0, 5.9), 1e-6);
  EXPECT_GT(json["rpe"]["translation_m"]["rmse"].get<double>(), 0.1);
}

TEST_F(Evaluate, BadInputIsRefusedWithOneLine) {
  const std::string broken =
      folder_.Write("broken.txt", "1.0 0 0 0 0 0 0 1\n2.0 nan 0 0 0 0 0 1\n");
  const std::string late = folder_.Write("late.txt", "100 0 0 0 0 0 0 1\n");
  ExpectRefusal({"trajectory", truth_, broken}, "broken.txt:2: tx is 'nan'");
  ExpectRefusal({"trajectory", broken, half_}, "broken.txt:2:");
  ExpectRefusal({"trajectory", truth_, folder_.path() / "none.txt"}, "none.txt: No such file");
  ExpectRefusal({"trajectory", truth_, late}, "no pose of the estimate has a partner");
}

TEST_F(Evaluate, BadUsageIsRefusedWithOneLine) {
  ExpectRefusal({}, "subcommand");
  ExpectRefusal({"trajectory", truth_}, "ESTIMATE");
  ExpectRefusal({"trajectory", truth_, half_, "--align", "affine"}, "affine");
  ExpectRefusal({"trajectory", truth_, half_, "--max-diff", "0"}, "--max-diff");
  ExpectRefusal({"trajectory", truth_, half_, "--no-such"}, "--no-such");
}

TEST_F(Evaluate, HelpIsNoError) {
  const ProgramResult result = RunProgram("evaluate", {"trajectory", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("--max-diff"), std::string::npos);
}

TEST(EvaluateData, PrintsAGoldenValue) {
  const auto truth = FindTestData("fr1_xyz/groundtruth.txt");
  const auto estimate = FindTestData("golden/freiburg1_xyz-rgbdslam.txt");
  if (!truth || !estimate) {
    GTEST_SKIP() << "the golden trajectories are not on this machine; set HULLSLAM_DATA";
  }
  const ProgramResult result = RunProgram("evaluate", {"trajectory", *truth, *estimate});
  EXPECT_NE(result.output.find("rmse 0.013473"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("786 (tum's rule"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace hullslam
