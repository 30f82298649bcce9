// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "files/read_file.h"
#include "hullslam/results/trajectory_file.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {

// Runs of a program for monocular SLAM.
class MonoProgram : public ::testing::Test {
 protected:
  using Arguments = std::vector<std::string>;
  using Json = nlohmann::json;

  explicit MonoProgram(std::string name) : name_(std::move(name)) {}

  ProgramResult Run(Arguments arguments) const {
    arguments.insert(arguments.end(), {"--output", output_});
    return RunProgram(name_, arguments);
  }

  // Expects exit code 0 and a map from which every frame has a pose.
  ProgramResult ExpectMap(const Arguments& arguments, int frames) const {
    ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const Json summary = Summary();
    EXPECT_EQ(summary["trajectory"]["frames"], frames);
    EXPECT_EQ(summary["trajectory"]["tracked"], frames);
    EXPECT_EQ(summary["trajectory"]["coverage"], 1.0);
    EXPECT_EQ(Poses().size(), static_cast<size_t>(frames));
    EXPECT_TRUE(summary["initialisation"]["seconds"].is_number());
    EXPECT_GE(summary["map"]["keyframes"], 2);
    EXPECT_GE(summary["map"]["landmarks"], 100);
    return result;
  }

  // Expects exit code 1, results without a pose, and an error that says how many frames made no map
  // because of `reason`.
  void ExpectNoMap(const Arguments& arguments, int frames, const std::string& reason) const {
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    ExpectParts(result.errors,
                {"error: no map could be made from " + std::to_string(frames) + " frames: ",
                 " x " + reason});
    // A run without poses has no trajectory error, and no message may say that its time stamps are
    // wrong.
    EXPECT_EQ(result.errors.find("trajectory error"), std::string::npos) << result.errors;
    const Json summary = Summary();
    EXPECT_TRUE(summary["initialisation"]["seconds"].is_null());
    EXPECT_GT(summary["initialisation"]["failures"].value(reason, 0), 0);
    EXPECT_EQ(summary["trajectory"]["tracked"], 0);
    EXPECT_EQ(summary["trajectory"]["alignment"], "sim3");  // with and without ground truth
    EXPECT_EQ(summary["trajectory"]["coverage"], 0.0);
    EXPECT_EQ(summary["map"]["keyframes"], 0);
    EXPECT_EQ(ReadFile(output_ / "trajectory.txt"), FormatTrajectory(Trajectory()));
  }

  // Expects exit code 2, an error with these parts, and no results.
  void ExpectRefusal(const Arguments& arguments, const std::vector<std::string>& parts) const {
    std::filesystem::remove_all(output_);
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    const size_t at = result.errors.find("error: ");
    ASSERT_NE(at, std::string::npos) << result.errors;
    ExpectParts(result.errors.substr(at), parts);
    EXPECT_FALSE(std::filesystem::exists(output_ / "summary.json"));
  }

  static void ExpectParts(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
      EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
    }
  }

  // The error of the run, m, as the program has computed it.
  double Ate() const {
    const Json trajectory = Summary()["trajectory"];
    EXPECT_EQ(trajectory["alignment"], "sim3");
    return trajectory["ate_rmse_m"].is_number() ? trajectory["ate_rmse_m"].get<double>() : 1e9;
  }

  Json Summary() const { return Json::parse(ReadFile(output_ / "summary.json")); }
  Trajectory Poses() const { return ReadTrajectory(output_ / "trajectory.txt"); }

  TemporaryFolder folder_;
  std::string path_ = folder_.path() / "sequence";
  std::filesystem::path output_ = folder_.path() / "out";

 private:
  std::string name_;
};

}  // namespace hullslam
