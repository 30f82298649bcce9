// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hullslam/settings/settings.h"
#include "support/plane_sequence.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/running_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class Calibrate : public ::testing::Test {
 protected:
  ProgramResult Run(const std::string& sequence, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {sequence, "--quiet", "--output", output_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunProgram("hullslam calibrate", arguments);
  }

  TemporaryFolder folder_;
  std::string output_ = (std::filesystem::path(folder_.path()) / "camera.yaml").string();
};

TEST_F(Calibrate, FindsTheFocalLengthAndKeepsWhatIsNotDetermined) {
  const RenderedDesk desk(60);
  const ProgramResult result =
      Run(desk.path(), {"--last", "39", "--set", "Camera.fx=551", "--set", "Camera.fy=554.9",
                        "--set", "Camera.readout_time=0.001"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("not determined, so it is kept"), std::string::npos);
  EXPECT_NE(result.output.find("to know more: "), std::string::npos) << result.output;
  const SystemOptions found = ReadSettings(output_);
  EXPECT_NEAR(found.camera.fx, 535.4, 4.0) << result.output;
  EXPECT_EQ(found.readout_time, 0.001) << result.output;
}

// The depth images of a folder in which each has the stamp of the one before it.
TEST_F(Calibrate, FindsThatDepthIsOfALaterTime) {
  const RenderedDesk desk(60);
  const std::filesystem::path path = std::filesystem::path(desk.path()) / "depth.txt";
  std::ifstream list(path);
  std::string shifted, stamp_before;
  for (std::string line; std::getline(list, line);) {
    const size_t end = line.find(' ');
    if (line.starts_with('#')) {
      continue;
    }
    if (!stamp_before.empty()) {
      shifted += stamp_before + line.substr(end) + '\n';
    }
    stamp_before = line.substr(0, end);
  }
  std::ofstream(path) << shifted;
  const ProgramResult result = Run(desk.path(), {});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const SystemOptions found = ReadSettings(output_);
  EXPECT_NEAR(found.depth.time_offset, 1.0 / 30.0, 6e-3) << result.output;
}

TEST_F(Calibrate, CheckOnlySaysWhatIsKnown) {
  const RenderedDesk desk(60);
  const ProgramResult result = Run(desk.path(), {"--check", "--last", "49"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("\nreadout_time "), std::string::npos) << result.output;
  EXPECT_EQ(result.output.find(" has the camera"), std::string::npos) << result.output;
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(Calibrate, RefusesWhatItCannotRead) {
  const ProgramResult missing = Run("/no/such/sequence", {});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_TRUE(missing.errors.starts_with("error: ")) << missing.errors;
  EXPECT_FALSE(std::filesystem::exists(output_));
  const ProgramResult format = Run(folder_.path(), {"--to", "blender"});
  EXPECT_EQ(format.exit_code, 2);
  EXPECT_NE(format.errors.find("--to"), std::string::npos) << format.errors;
}

TEST_F(Calibrate, WritesNothingIfItIsInterrupted) {
  const RenderedDesk desk(60);
  RunningProgram program("hullslam calibrate", {desk.path(), "--output", output_});
  program.ReadLine();  // the first progress
  program.Send(SIGINT);
  EXPECT_EQ(program.Wait(), 1);
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(Calibrate, SaysThatARecordingIsTooShort) {
  const PlaneSequence sequence(5);
  const ProgramResult result = Run(sequence.path(), {});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("film for longer"), std::string::npos) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(output_));
}

}  // namespace
}  // namespace hullslam
