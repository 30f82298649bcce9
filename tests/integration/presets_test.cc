// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of the programs with presets of published systems.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "hullslam/settings/preset.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::json;

constexpr int kPresetFrames = 100;

class PresetRuns : public ::testing::Test {
 protected:
  explicit PresetRuns(int frames = kPresetFrames) : desk_(frames) {}

  std::string Masks() const { return desk_.path() / "masks"; }
  ProgramResult Run(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), desk_.path());
    arguments.insert(arguments.end(), {"--output", folder_.path() / "out"});
    return RunProgram(program, arguments);
  }
  Json Summary() const { return Json::parse(ReadFile(folder_.path() / "out" / "summary.json")); }

  // The system maps objects in all programs, if it has objects.
  void RunAllPrograms(const std::string& preset) const;

  RenderedDesk desk_;
  TemporaryFolder folder_;
};

void PresetRuns::RunAllPrograms(const std::string& preset) const {
  const bool has_objects = preset != "orb_slam2";
  const ProgramResult depth =
      Run("rgbd_tum", {"--preset", preset, "--masks", Masks(), "--overwrite"});
  ASSERT_EQ(depth.exit_code, 0) << depth.errors;
  EXPECT_NE(depth.output.find("preset: " + preset + " ("), std::string::npos) << depth.output;
  const Json summary = Summary();
  EXPECT_EQ(summary["provenance"]["preset"], preset);
  EXPECT_TRUE(summary["provenance"]["preset_overrides"].empty());
  EXPECT_EQ(summary["trajectory"]["tracked"], kPresetFrames);
  EXPECT_LT(summary["trajectory"]["ate_rmse_m"], 0.01);
  EXPECT_EQ(summary["objects"]["count"] > 0, has_objects) << summary["objects"];

  const ProgramResult mono =
      Run("mono_tum", {"--preset", preset, "--masks", Masks(), "--overwrite"});
  ASSERT_EQ(mono.exit_code, 0) << mono.errors;
  EXPECT_EQ(Summary()["provenance"]["preset"], preset);
  EXPECT_LT(Summary()["trajectory"]["ate_rmse_m"], 0.02);

  const ProgramResult known =
      RunProgram("hullslam", {"map-objects", desk_.path(), "--preset", preset, "--masks", Masks(),
                              "--poses", desk_.path() / "groundtruth.txt", "--min-distance", "0.02",
                              "--overwrite", "--output", folder_.path() / "out"});
  if (has_objects) {
    ASSERT_EQ(known.exit_code, 0) << known.errors;
    EXPECT_EQ(Summary()["provenance"]["preset"], preset);
    EXPECT_GT(Summary()["objects"]["count"], 0) << Summary()["objects"];
  } else {
    EXPECT_EQ(known.exit_code, 2);
    EXPECT_NE(known.errors.find("objects.enabled is false (--preset orb_slam2)"), std::string::npos)
        << known.errors;
  }
}

TEST_F(PresetRuns, MapObjectsIfTheSystemDoes) {
  for (const std::string& preset : PresetNames()) {
    SCOPED_TRACE(preset);
    RunAllPrograms(preset);
  }
}

class PresetArguments : public PresetRuns {
 protected:
  PresetArguments() : PresetRuns(20) {}
};

TEST_F(PresetArguments, AnUnknownPresetListsTheKnownOnes) {
  const ProgramResult result = Run("rgbd_tum", {"--preset", "orb-slam2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("expected one of: hullslam, oa_slam"), std::string::npos)
      << result.errors;
  EXPECT_NE(result.errors.find("did you mean 'orb_slam2'?"), std::string::npos) << result.errors;
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
}

TEST_F(PresetArguments, ASystemWithObjectsNeedsMasks) {
  const ProgramResult result = Run("rgbd_tum", {"--preset", "voom"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("the preset voom needs masks"), std::string::npos) << result.errors;
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  const ProgramResult points =
      Run("rgbd_tum", {"--preset", "voom", "--set", "objects.enabled=false"});
  EXPECT_EQ(points.exit_code, 0) << points.errors;
}

TEST_F(PresetArguments, WhatReplacesAPresetIsSaidAndListed) {
  const std::string settings = folder_.path() / "mine.yaml";
  fs::copy_file(desk_.settings(), settings);
  std::ofstream(settings, std::ios::app) << "\nmapping.local_keyframes: 15\n";
  const ProgramResult result = Run("rgbd_tum", {"--preset", "orb_slam2", "--settings", settings,
                                                "--set", "tracking.min_inliers=25"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.errors.find("mapping.local_keyframes is 15, but the preset orb_slam2 has"),
            std::string::npos)
      << result.errors;
  EXPECT_NE(result.output.find("--set tracking.min_inliers=25 replaces 30"), std::string::npos)
      << result.output;
  const Json overrides = Summary()["provenance"]["preset_overrides"];
  ASSERT_EQ(overrides.size(), 2u);
  EXPECT_EQ(overrides[0]["key"], "mapping.local_keyframes");
  EXPECT_EQ(overrides[0]["preset_value"], "1000000");
  EXPECT_EQ(overrides[0]["value"], "15");
  EXPECT_EQ(overrides[1]["source"], "--set");
}

}  // namespace
}  // namespace hullslam
