// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(MakeSynthetic, BadUsageIsRefusedAndWritesNothing) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  EXPECT_EQ(RunProgram("make_synthetic", {"--help"}).exit_code, 0);
  EXPECT_EQ(RunProgram("make_synthetic", {}).exit_code, 2);
  EXPECT_EQ(RunProgram("make_synthetic", {out, "--frames", "0"}).exit_code, 2);
  EXPECT_EQ(RunProgram("make_synthetic", {out, "--frames", "many"}).exit_code, 2);
  for (const char* const seconds : {"0.2", "-0.2", "nan", "inf"}) {
    EXPECT_EQ(RunProgram("make_synthetic", {out, "--readout-time", seconds}).exit_code, 2);
  }
  EXPECT_EQ(RunProgram("make_synthetic", {out, "--colour"}).exit_code, 2);
  EXPECT_EQ(RunProgram("make_synthetic", {out, "--seed", "-1"}).exit_code, 2);
  EXPECT_EQ(RunProgram("make_synthetic", {out, "--rearranged", "-1"}).exit_code, 2);
  EXPECT_EQ(RunProgram("make_synthetic", {out, "--readout-time", "nan"}).exit_code, 2);
  const ProgramResult result = RunProgram("make_synthetic", {out, "--scene", "kitchen"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("lowtexture"), std::string::npos) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(MakeSynthetic, ReplacesItsOwnSequenceOnlyWithForce) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  EXPECT_EQ(RunProgram("make_synthetic", {out, "--frames", "1"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / "groundtruth_objects.json"));
  const ProgramResult again = RunProgram("make_synthetic", {out, "--frames", "1"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.errors.find("--force"), std::string::npos) << again.errors;
  EXPECT_EQ(RunProgram("make_synthetic", {out, "--frames", "1", "--force", "--quiet"}).exit_code,
            0);
}

}  // namespace
}  // namespace hullslam
