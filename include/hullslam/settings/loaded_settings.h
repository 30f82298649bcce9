// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/settings/preset.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/options.h"

namespace hullslam {

// The settings of a run, the preset that they are based on, and what the user should know about
// them.
struct LoadedSettings {
  SystemOptions options;
  std::optional<Preset> preset = std::nullopt;
  SettingsNotes notes = {};
};

// Like ReadSettings() and MakeSettings(), but they read the preset: a name or a file; empty: none.
LoadedSettings LoadSettings(const std::filesystem::path& file, const std::string& preset = {},
                            std::span<const std::string> overrides = {},
                            NegativeFy negative_fy = NegativeFy::kError);
LoadedSettings LoadSettings(const CameraCalibration& calibration, const std::string& source,
                            const std::string& preset = {},
                            std::span<const std::string> overrides = {});

// Throws InputError if the preset needs masks and there are none, unless objects are switched off.
void CheckPresetHasMasks(const LoadedSettings& settings, const std::filesystem::path& masks);

// "preset: NAME (FILE)" and what --set has replaced in it, which a user sees before a run. Empty
// without a preset. (What a settings file replaces is a warning of LoadSettings().)
std::string DescribePreset(const LoadedSettings& settings);

}  // namespace hullslam
