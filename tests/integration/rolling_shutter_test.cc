// SPDX-License-Identifier: GPL-3.0-or-later
// Runs on images of a camera that exposes row after row while it moves.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr int kShutterFrames = 60;

const RenderedDesk& Desk() {
  static const RenderedDesk desk(kShutterFrames, 0.03);
  return desk;
}

// The ATE of a run of the program with these arguments, mm.
double RunAte(const std::string& program, std::vector<std::string> arguments) {
  const TemporaryFolder folder;
  const std::string output = folder.path() / "out";
  arguments.insert(arguments.begin(), {Desk().path(), "--output", output, "--quiet"});
  const ProgramResult result = RunProgram(program, arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const auto summary = nlohmann::json::parse(ReadFile(output + "/summary.json"));
  EXPECT_EQ(summary["trajectory"]["tracked"], kShutterFrames);
  return 1e3 * summary["trajectory"]["ate_rmse_m"].get<double>();
}

class RollingShutter : public testing::TestWithParam<std::string> {};  // program

// The settings that make_synthetic writes say how long the shutter takes.
TEST_P(RollingShutter, IsCorrected) {
  const double corrected = RunAte(GetParam(), {});
  const double ignored = RunAte(GetParam(), {"--set", "Camera.readout_time=0"});
  EXPECT_LT(corrected, 0.75 * ignored) << ignored << " mm without the correction";
}

TEST_P(RollingShutter, IsCorrectedWithObjects) {
  const std::string masks = Desk().path() / "masks";
  const double corrected = RunAte(GetParam(), {"--masks", masks});
  const double ignored = RunAte(GetParam(), {"--masks", masks, "--set", "Camera.readout_time=0"});
  EXPECT_LT(corrected, 0.75 * ignored) << ignored << " mm without the correction";
}

INSTANTIATE_TEST_SUITE_P(Programs, RollingShutter, testing::Values("mono_tum", "rgbd_tum"));

}  // namespace
}  // namespace hullslam
