// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/preset_comparison.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

const Preset kPreset{.name = "made",
                     .file = "made.yaml",
                     .settings = {{"objects.sigma", "3", "made.yaml:2"},
                                  {"loop.closing", "true", "made.yaml:3"},
                                  {"tracking.min_inliers", "30", "made.yaml:4"}}};

TEST(PresetComparison, NamesWhatWasReplacedAndBySomethingElse) {
  SystemOptions options;
  OptionTable table = options.Bind();
  const PresetComparison comparison(kPreset, table);
  EXPECT_EQ(options.objects.pose.constraint.sigma_px, 3.0);
  EXPECT_TRUE(comparison.FindOverrides(table, {}).empty());
  table.Set("objects.pose.sigma", "4", "file:7");
  table.Set("tracking.min_inliers", "+30", "file:8");  // the same value
  table.Set("loop.min_matches", "25", "file:9");       // the preset does not set it
  const auto overrides = comparison.FindOverrides(table, {{"objects.pose.sigma", "file:7"},
                                                          {"tracking.min_inliers", "file:8"},
                                                          {"loop.min_matches", "file:9"}});
  ASSERT_EQ(overrides.size(), 1u);
  EXPECT_EQ(overrides[0].key, "objects.pose.sigma");
  EXPECT_EQ(overrides[0].preset_value, "3");
  EXPECT_EQ(overrides[0].value, "4");
  EXPECT_EQ(overrides[0].origin, "file:7");
}

TEST(PresetComparison, ADefaultThatThePresetNamesCountsToo) {
  SystemOptions options;
  OptionTable table = options.Bind();
  const PresetComparison comparison(kPreset, table);
  table.Set("loop.closing", "false", "--set");
  const auto overrides = comparison.FindOverrides(table, {{"loop.closing", "--set"}});
  ASSERT_EQ(overrides.size(), 1u);
  EXPECT_EQ(overrides[0].key, "loop.closing");
}

TEST(PresetComparison, TheMessageSaysThatTheFileCounts) {
  const std::string message =
      Describe({.key = "a.b", .preset_value = "1", .value = "2", .origin = "c.yaml:9"}, kPreset);
  EXPECT_EQ(message, "c.yaml:9: a.b is 2, but the preset made has 1; the value of the file counts");
}

}  // namespace
}  // namespace hullslam
