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
#include "results/summary.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// The settings of a run, and the preset that they are based on.
struct LoadedSettings {
  SystemOptions options;
  std::optional<Preset> preset = std::nullopt;
  std::vector<PresetOverride> preset_overrides = {};
  std::string camera_note = {};  // this and the others as in SettingsNotes
  int read_width = 0;
  int read_height = 0;
  bool has_baseline = false;
};

// A settings file and the reason why a program takes it.
struct SettingsChoice {
  std::filesystem::path file;
  std::string reason;
};

// `given`, the file of --settings, if it is not empty. Otherwise the one of FindDefaultSettings()
// for the folder of a sequence.
SettingsChoice ChooseTumSettings(const std::filesystem::path& given,
                                 const std::filesystem::path& sequence);
// The rule in words, for --help.
inline constexpr const char* kTumSettingsRule =
    "default: camera.yaml in SEQUENCE; without it, the file in config/ that fits the "
    "folder's name, such as TUM1.yaml for freiburg1";
// The same for ICL-NUIM: camera.yaml in the folder of the sequence, else config/ICL.yaml.
SettingsChoice ChooseIclSettings(const std::filesystem::path& given,
                                 const std::filesystem::path& sequence);

// For the file of --settings, which is not empty.
SettingsChoice GivenSettings(const std::filesystem::path& given);

// "settings: FILE (REASON)", which a user sees before a run.
std::string Describe(const SettingsChoice& choice);

// Adds --settings. `rule` is its default in words.
void AddSettingsArgument(CLI::App& app, const std::string& rule, std::filesystem::path& settings);
// Adds --preset.
void AddPresetArgument(CLI::App& app, std::string& preset);

// Like ReadSettings() and MakeSettings(), but they read the preset (a name or a file; empty: none)
// and print the warnings on stderr.
LoadedSettings LoadSettings(const std::filesystem::path& file, const std::string& preset,
                            std::span<const std::string> overrides,
                            NegativeFy negative_fy = NegativeFy::kError);
LoadedSettings LoadSettings(const CameraCalibration& calibration, const std::string& source,
                            const std::string& preset, std::span<const std::string> overrides);

// Throws InputError if the preset needs masks and there are none, unless objects are switched off.
void CheckPresetHasMasks(const LoadedSettings& settings, const std::filesystem::path& masks);

// "preset: NAME (FILE)" and what --set has replaced in it, which a user sees before a run. Empty
// without a preset. (What a settings file replaces is a warning of LoadSettings().)
std::string DescribePreset(const LoadedSettings& settings);

// Writes the preset and what replaces its settings into the summary of a run.
void AddPreset(const LoadedSettings& settings, ProvenanceSummary& provenance);

}  // namespace hullslam
