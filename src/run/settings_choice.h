// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace hullslam {

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

}  // namespace hullslam
