// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "hullslam/settings/settings.h"
#include "settings/camera_file.h"
#include "support/made_room.h"
#include "support/plane_sequence.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/running_program.h"
#include "support/temporary_folder.h"
#include "support/turned_right.h"

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
      Run(desk.path(), {"--last", "49", "--set", "Camera.fx=551", "--set", "Camera.fy=554.9",
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

// Pairs of the room, whose right camera may be turned.
class CalibratePairs : public Calibrate {
 protected:
  static constexpr int kFrames = 24;

  void WritePairs() {
    room_.WritePairs(path_, "left", "right", kFrames, 0.12);
    PinholeCamera camera = room_.camera();
    camera.bf = 0.12 * camera.fx;
    folder_.Write("pairs/camera.yaml",
                  CameraFileText(CameraFormat::kSettings, camera, 10.0, {}, {}));
  }
  ProgramResult RunSlam(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {path_, "--quiet", "--overwrite", "--output",
                                          (folder_.path() / "out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunProgram("hullslam run", arguments);
  }
  static void ExpectParts(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
      EXPECT_NE(text.find(part), std::string::npos) << "expected '" << part << "' in:\n" << text;
    }
  }
  double Ate() const {
    return nlohmann::json::parse(
               ReadFile(folder_.path() / "out" / "summary.json"))["trajectory"]["ate_rmse_m"]
        .get<double>();
  }

  MadeRoom room_;
  std::filesystem::path path_ = folder_.path() / "pairs";
};

TEST_F(CalibratePairs, ARightPairStays) {
  WritePairs();
  const ProgramResult result = Run(path_, {});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  ExpectParts(result.output, {"\npitch ", "agrees, so it is kept", "no images tell its length"});
  EXPECT_EQ(ReadFile(output_).find("Camera2"), std::string::npos) << result.output;
}

TEST_F(CalibratePairs, ATurnedRightCameraIsFoundAndItsSettingsAreUsed) {
  WritePairs();
  TurnImages(path_ / "right", room_.camera(), {0.009, 0.0, 0.005});
  const ProgramResult before = RunSlam({});
  EXPECT_EQ(before.exit_code, 2);
  ExpectParts(before.errors, {"expected equal rows", "`hullslam calibrate`"});
  const ProgramResult result = Run(path_, {});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  ExpectParts(result.output, {"the cameras of the pair"});
  const std::string text = ReadFile(output_);
  ExpectParts(text, {"Camera2.fx: ", "Stereo.T_c1_c2: ", "# roll of the right camera: 0.2"});
  const ProgramResult after = RunSlam({"--settings", output_});
  ASSERT_EQ(after.exit_code, 0) << after.errors;
  EXPECT_EQ(after.errors.find("wrong by"), std::string::npos) << after.errors;
  EXPECT_LT(Ate(), 0.01);
  // The corrected pair is right.
  const ProgramResult again = Run(path_, {"--check", "--settings", output_});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  ExpectParts(again.output, {"agrees, so it is kept"});
}

TEST_F(CalibratePairs, PairsThatAreAFrameApartAreRefused) {
  WritePairs();
  for (int i = 1; i < kFrames; ++i) {
    std::filesystem::rename(path_ / "right" / fmt::format("{:06}.png", i),
                            path_ / "right" / fmt::format("{:06}.png", i - 1));
  }
  const ProgramResult result = Run(path_, {});
  EXPECT_EQ(result.exit_code, 2);
  ExpectParts(result.errors, {"do not belong together in time", "later"});
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
