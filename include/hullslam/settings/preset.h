// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hullslam/system/options.h"

namespace hullslam {

// One line of the file of a preset.
struct PresetSetting {
  std::string key;
  std::string value;   // as OptionTable::Set() takes it
  std::string origin;  // FILE:LINE
};

// A named set of settings (docs/presets.md). The shipped ones make HullSLAM work as published
// systems do; a user can write others.
struct Preset {
  std::string name;
  std::filesystem::path file;
  bool needs_masks = false;             // without masks the preset would be another system
  std::vector<PresetSetting> settings;  // of the preset that it is based on first
};

// The names of the presets in the folder of known settings (FindConfigFolder()), sorted: its files
// `presets/*.yaml` without the ending. Throws InputError if there is no such folder.
std::vector<std::string> PresetNames();

// Reads a preset: one of PresetNames(), or the path of a file that ends in .yaml or .yml. The file
// has the format of a settings file, but needs no intrinsics. Two keys are only for presets:
// `preset.base` names another preset, whose settings come before its own, and `preset.needs_masks`
// is true or false (if missing, as in the base, else false). Throws InputError that lists the
// names if the name is unknown, and the errors of ReadSettings() for a bad file.
Preset ReadPreset(const std::string& name_or_file);

// Sets the settings of the preset; all others stay as they are. Throws InputError if a value cannot
// be used.
void ApplyPreset(const Preset& preset, SystemOptions& options);

}  // namespace hullslam
