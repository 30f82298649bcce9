// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "hullslam/settings/loaded_settings.h"
#include "results/summary.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// Adds --settings. `rule` is its default in words.
void AddSettingsArgument(CLI::App& app, const std::string& rule, std::filesystem::path& settings);
// Adds --preset.
void AddPresetArgument(CLI::App& app, std::string& preset);

// Prints the warnings of settings on stderr.
void PrintSettingsWarnings(const LoadedSettings& settings);

// Throws InputError if the preset needs masks and there are none, unless objects are switched off.
void CheckPresetHasMasks(const LoadedSettings& settings, const std::filesystem::path& masks);

// "preset: NAME (FILE)" and what --set has replaced in it, which a user sees before a run. Empty
// without a preset. (What a settings file replaces is a warning of LoadSettings().)
std::string DescribePreset(const LoadedSettings& settings);

// Writes the preset and what replaces its settings into the summary of a run.
void AddPreset(const LoadedSettings& settings, ProvenanceSummary& provenance);

}  // namespace hullslam
