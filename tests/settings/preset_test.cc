// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/settings/preset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <tuple>
#include <vector>

#include "hullslam/settings/settings.h"
#include "support/expect_error.h"
#include "support/paths.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// NOLINTBEGIN(concurrency-mt-unsafe): tests run one after the other
class Presets : public ::testing::Test {
 protected:
  Presets() { ::setenv("HULLSLAM_CONFIG", (SourceFolder() / "config").c_str(), 1); }
  ~Presets() override { ::unsetenv("HULLSLAM_CONFIG"); }
  Presets(const Presets&) = delete;
  Presets& operator=(const Presets&) = delete;

  std::string Write(const std::string& name, const std::string& lines) const {
    return folder_.Write(name, "%YAML:1.0\n" + lines);
  }
  static SystemOptions Apply(const std::string& preset) {
    SystemOptions options;
    ApplyPreset(ReadPreset(preset), options);
    return options;
  }

  TemporaryFolder folder_;
};
// NOLINTEND(concurrency-mt-unsafe)

TEST_F(Presets, AllSystemsOfTheTablesAreThere) {
  const std::vector<std::string> expected = {
      "hullslam",      "oa_slam",   "oa_slam_ba",  "orb_slam2", "paper",
      "paper_literal", "qiso_slam", "quadricslam", "song2022",  "voom"};
  EXPECT_EQ(PresetNames(), expected);
}

TEST_F(Presets, EveryPresetCanBeAppliedAndUsed) {
  for (const std::string& name : PresetNames()) {
    const Preset preset = ReadPreset(name);
    EXPECT_EQ(preset.name, name);
    SystemOptions options;
    ApplyPreset(preset, options);
    EXPECT_NO_THROW(options.objects.Validate()) << name;
    const bool has_objects = name != "orb_slam2" && name != "hullslam";
    EXPECT_EQ(preset.needs_masks, has_objects) << name;
    EXPECT_EQ(options.objects.enabled, name != "orb_slam2") << name;
  }
}

TEST_F(Presets, OfHullslamIsTheDefaults) {
  EXPECT_EQ(FormatSettings(Apply("hullslam")), FormatSettings(SystemOptions()));
}

// What is ours and what changes accuracy is off in every published system.
TEST_F(Presets, OfPublishedSystemsHaveTheFrontEndOfOrbSlam2) {
  for (const std::string& name : PresetNames()) {
    if (name == "hullslam") {
      continue;
    }
    const SystemOptions options = Apply(name);
    EXPECT_FALSE(options.tracking.correct_shutter) << name;
    EXPECT_FALSE(options.tracking.refine_at_end) << name;
    EXPECT_FALSE(options.tracking.locate_at_end) << name;
    EXPECT_FALSE(options.tracking.remove_dynamic) << name;
    EXPECT_EQ(options.tracking.keyframe_rule, KeyframeRule::kOrbSlam2) << name;
    EXPECT_EQ(options.mapping.culling_rule, MappingRule::kOrbSlam2) << name;
    EXPECT_EQ(options.mapping.landmark_rule, MappingRule::kOrbSlam2) << name;
    EXPECT_FALSE(options.mapping.final_bundle_adjustment) << name;
    EXPECT_EQ(options.depth.error.model, DepthErrorModel::kRightColumn) << name;
    EXPECT_EQ(options.depth.error.adjustment_rule, AdjustmentRule::kOrbSlam2) << name;
    EXPECT_EQ(options.depth.error.pixel_sigma, 1.0) << name;
    EXPECT_FALSE(options.loop.object_votes) << name;
    if (options.objects.enabled) {
      EXPECT_FALSE(options.objects.misfit_compensation) << name;
      EXPECT_EQ(options.objects.guided_matching, name == "voom") << name;
      EXPECT_EQ(options.tracking.relocalise_by_objects, name.starts_with("oa_slam")) << name;
    }
  }
}

// How a system uses objects, as the table of docs/presets.md says.
TEST_F(Presets, UseObjectsAsTheirSystemsDo) {
  const std::vector<std::tuple<std::string, bool, bool, ObjectResidual>> uses = {
      {"quadricslam", true, true, ObjectResidual::kBoxBounds},
      {"oa_slam", false, false, ObjectResidual::kBhattacharyya},
      {"oa_slam_ba", false, true, ObjectResidual::kBhattacharyya},
      {"song2022", false, false, ObjectResidual::kAlgebraicPlane},
      {"qiso_slam", false, true, ObjectResidual::kFilteredPoint},
      {"voom", false, false, ObjectResidual::kBhattacharyya},
      {"paper", true, true, ObjectResidual::kRelativePlane},
      {"paper_literal", true, true, ObjectResidual::kAlgebraicPlane}};
  for (const auto& [name, joint_pose, bundle_adjustment, residual] : uses) {
    const ObjectOptions objects = Apply(name).objects;
    EXPECT_EQ(objects.joint_pose, joint_pose) << name;
    EXPECT_EQ(objects.bundle_adjustment, bundle_adjustment) << name;
    EXPECT_EQ(objects.refinement.constraint.residual, residual) << name;
  }
}

TEST_F(Presets, TheLiteralPaperDiffersByItsResidualOnly) {
  const std::string mine =
      Write("mine.yaml", "preset.base: paper\nobjects.residual: algebraic_plane\n");
  EXPECT_EQ(FormatSettings(Apply(mine)), FormatSettings(Apply("paper_literal")));
  EXPECT_NE(FormatSettings(Apply(mine)), FormatSettings(Apply("paper")));
}

TEST_F(Presets, AnUnknownNameListsTheKnownOnes) {
  ExpectInputError([] { ReadPreset("orbslam2"); },
                   {"--preset", "no preset 'orbslam2'", "hullslam, oa_slam", "voom",
                    "did you mean 'orb_slam2'?"});
  ExpectInputError([] { ReadPreset(""); }, {"no preset ''", "hullslam"});
  ExpectInputError([] { ReadPreset("../presets/voom"); }, {"no preset '../presets/voom'"});
}

TEST_F(Presets, MayBeFilesOfTheUser) {
  const Preset preset = ReadPreset(
      Write("mine.yaml", "objects.residual: tangent  # ours, 'as' is\npreset.needs_masks: 1\n"));
  EXPECT_EQ(preset.name, "mine");
  EXPECT_TRUE(preset.needs_masks);
  ASSERT_EQ(preset.settings.size(), 1u);
  EXPECT_EQ(preset.settings[0].value, "tangent");
  EXPECT_TRUE(preset.settings[0].origin.ends_with("mine.yaml:2")) << preset.settings[0].origin;
}

TEST_F(Presets, MayBeBasedOnOthers) {
  const std::string mine = Write("mine.yaml", "preset.base: voom\nobjects.joint_pose: true\n");
  const Preset preset = ReadPreset(mine);
  EXPECT_EQ(preset.name, "mine");
  EXPECT_TRUE(preset.needs_masks);
  SystemOptions options;
  ApplyPreset(preset, options);
  EXPECT_TRUE(options.objects.joint_pose);
  EXPECT_EQ(options.objects.start.method, ObjectStart::kSingleView);
  EXPECT_EQ(options.tracking.keyframe_rule, KeyframeRule::kOrbSlam2);
}

TEST_F(Presets, TheFileOfABaseIsBesideThePreset) {
  Write("first.yaml", "objects.sigma: 2\n");
  const std::string second = Write("second.yaml", "preset.base: first.yaml\n");
  EXPECT_EQ(Apply(second).objects.pose.constraint.sigma_px, 2.0);
}

TEST_F(Presets, ThatAreBasedOnEachOtherAreRefused) {
  const std::string mine = folder_.path() / "mine.yaml";
  Write("mine.yaml", "preset.base: " + mine + "\n");
  ExpectInputError([&] { ReadPreset(mine); }, {"mine.yaml:2", "preset.base", "10 presets"});
}

TEST_F(Presets, BrokenFilesNameFileLineAndKey) {
  const auto expect = [&](const std::string& lines, std::vector<std::string> parts) {
    parts.emplace_back("broken.yaml");
    const std::string file = Write("broken.yaml", lines);
    ExpectInputError([&] { ReadPreset(file); }, parts);
  };
  expect("objects.residuals: tangent\n", {":2", "unknown key", "did you mean 'objects.residual'"});
  expect("objects.residual: tangents\n", {":2", "objects.residual is 'tangents'", "one of"});
  expect("preset.base: 3\n", {":2", "preset.base", "no preset '3'"});
  expect("preset.base: vom\n", {":2", "no preset 'vom'", "did you mean 'voom'?"});
  expect("preset.needs_masks: maybe\n", {":2", "preset.needs_masks is 'maybe'", "true or false"});
  expect("preset.needs_mask: 1\n", {":2", "unknown key 'preset.needs_mask'"});
  expect("objects.sigma: [1, 2]\n", {":2", "a list"});
  expect("objects.sigma: 1\nobjects.sigma: 2\n", {":3", "given before"});
  expect("", {"no settings"});
  ExpectInputError([&] { ReadPreset(folder_.path() / "none.yaml"); }, {"none.yaml"});
  folder_.Write("text.yaml", "some text\n");
  ExpectInputError([&] { ReadPreset(folder_.path() / "text.yaml"); },
                   {"text.yaml", "has no settings"});
}

TEST_F(Presets, AreSoughtInTheFolderOfSettings) {
  folder_.Write("presets/own.yaml", "%YAML:1.0\nobjects.sigma: 2\n");
  folder_.Write("presets/README.md", "no preset");
  // NOLINTBEGIN(concurrency-mt-unsafe)
  ::setenv("HULLSLAM_CONFIG", folder_.path().c_str(), 1);
  EXPECT_EQ(PresetNames(), std::vector<std::string>{"own"});
  EXPECT_EQ(Apply("own").objects.pose.constraint.sigma_px, 2.0);
  ExpectInputError([] { ReadPreset("voom"); }, {"no preset 'voom'", "expected one of: own"});
  const TemporaryFolder empty;
  ::setenv("HULLSLAM_CONFIG", empty.path().c_str(), 1);
  // NOLINTEND(concurrency-mt-unsafe)
  ExpectInputError([] { PresetNames(); }, {"presets is not a folder"});
}

}  // namespace
}  // namespace hullslam
