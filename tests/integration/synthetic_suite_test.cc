// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

class SyntheticSuite : public ::testing::Test {
 protected:
  // The message of a call that must be refused and write nothing.
  std::string Refusal(const std::vector<std::string>& arguments, const std::string& setup = "",
                      int exit_code = 2) const {
    const ProgramResult result = RunProgram("make_synthetic", arguments, setup);
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    EXPECT_TRUE(fs::is_empty(root_.path())) << arguments.back();
    return result.errors;
  }

  TemporaryFolder root_;
  std::string out_ = (root_.path() / "suite").string();
};

// Both forms, with few frames, are read by the programs for their data sets.
TEST_F(SyntheticSuite, SequencesOfBothFormsAreReadByTheirPrograms) {
  const ProgramResult made = RunProgram(
      "make_synthetic", {"--suite", out_, "--frames", "6", "--only", "icl2,desk2", "--seed", "4"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_NE(made.output.find("2 sequences of 6 frames, seed 4"), std::string::npos) << made.output;
  const auto suite = nlohmann::json::parse(ReadFile(fs::path(out_) / "suite.json"));
  ASSERT_EQ(suite["sequences"].size(), 2U);
  for (const auto& sequence : suite["sequences"]) {
    const auto path = [&](const char* key) {
      return (fs::path(out_) / sequence[key].get<std::string>()).string();
    };
    const std::string dataset = sequence["dataset"];
    const std::string run = (root_.path() / ("rgbd-" + dataset)).string();
    const ProgramResult rgbd = RunProgram(
        "rgbd_" + dataset, {path("folder"), "--masks", path("masks"), "--output", run, "--quiet"});
    EXPECT_EQ(rgbd.exit_code, 0) << rgbd.errors;
    const auto trajectory =
        nlohmann::json::parse(ReadFile(fs::path(run) / "summary.json"))["trajectory"];
    EXPECT_EQ(trajectory["tracked"], 6);
    EXPECT_EQ(trajectory["pairs"], dataset == "icl" ? 5 : 6);
    EXPECT_LT(trajectory["ate_rmse_m"].get<double>(), 0.01);
    const ProgramResult check =
        RunProgram("hullslam check-masks", {path("tum_folder"), path("masks")});
    EXPECT_EQ(check.exit_code, 0) << check.errors;
    const ProgramResult mono =
        RunProgram("mono_" + dataset, {path("folder"), "--output", run + "-mono", "--quiet"});
    EXPECT_NE(mono.exit_code, 2) << mono.errors << "six frames may be too few to start";
  }
}

TEST_F(SyntheticSuite, BadUsageIsRefusedAndWritesNothing) {
  EXPECT_NE(Refusal({"--suite", out_, "--only", "desk1,kitchen"}).find("'kitchen'"),
            std::string::npos);
  EXPECT_NE(Refusal({"--suite", out_, "--only", "kitchen"}).find("desk1, desk2, person, dishes"),
            std::string::npos);
  EXPECT_NE(Refusal({"--suite", out_, "--only", ""}).find("no sequence ''"), std::string::npos);
  for (const char* const frames : {"-1", "0", "1", "x", "1000000"}) {
    EXPECT_NE(Refusal({"--suite", out_, "--frames", frames}).find("--frames"), std::string::npos);
  }
  EXPECT_NE(Refusal({"--suite", out_, "--seed", "-1"}).find("--seed"), std::string::npos);
  EXPECT_NE(Refusal({"--suite", out_, "--scene", "room"}).find("--suite"), std::string::npos);
  EXPECT_NE(Refusal({"--suite", out_, "--rearranged", "1"}).find("--suite"), std::string::npos);
  EXPECT_NE(Refusal({"--suite", out_, out_}).find("--suite"), std::string::npos);
  EXPECT_NE(Refusal({out_, "--only", "desk1"}).find("--suite"), std::string::npos);
  EXPECT_NE(Refusal({"--suite"}).find("--suite"), std::string::npos);
  EXPECT_NE(Refusal({"--suite", ""}).find("--suite"), std::string::npos);
  EXPECT_NE(Refusal({}).find("OUT"), std::string::npos);
}

TEST_F(SyntheticSuite, OnAFullDiskNothingIsLeft) {
  EXPECT_NE(Refusal({"--suite", out_, "--frames", "2", "--only", "icl3", "--quiet"},
                    "trap '' XFSZ; ulimit -f 100;")
                .find("is the disk full?"),
            std::string::npos);
}

TEST_F(SyntheticSuite, AFolderWithOtherThingsIsRefused) {
  root_.Write("suite/thesis.txt", "precious");
  const ProgramResult result =
      RunProgram("make_synthetic", {"--suite", out_, "--frames", "2", "--force"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("is not (only) a suite"), std::string::npos) << result.errors;
  EXPECT_EQ(ReadFile(fs::path(out_) / "thesis.txt"), "precious");
}

}  // namespace
}  // namespace hullslam
