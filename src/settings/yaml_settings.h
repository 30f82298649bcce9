// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <yaml-cpp/node/node.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/util/option_table.h"

namespace hullslam {

// A setting as it is written in a settings file.
struct WrittenSetting {
  std::string key;     // the key of OptionTable
  std::string name;    // the key in the file; differs from `key` in files of other programs
  std::string origin;  // FILE:LINE
  // The value for OptionTable::Set(). A quoted number keeps its quotes, so that it is not accepted
  // as a number.
  std::string text = {};
  std::string_view no_value = {};  // "a list" or "a map" if it is not a single value
  // The content of a map whose values are single: `name:value` pairs, separated by commas.
  std::optional<std::string> pairs = std::nullopt;
};

// Reads a file of `key: value` lines as ReadYaml() does. The settings are in the order of the file.
// Throws InputError with file and line if the file has another format or gives a key twice.
std::vector<WrittenSetting> ReadYamlSettings(const std::filesystem::path& file);
// The same for a file that ReadYaml() has read.
std::vector<WrittenSetting> ReadYamlSettings(const std::filesystem::path& file,
                                             const YAML::Node& root);

// The text of the setting. Throws InputError if it is not a single value.
const std::string& SingleValue(const WrittenSetting& setting);

// The text that OptionTable::Set() takes for the setting. Empty for an unknown key, so that it is
// reported as such. Throws InputError if the option is no map and the setting is not a single
// value.
std::string TextOf(const WrittenSetting& setting, const OptionTable& table);

}  // namespace hullslam
