// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// A setting as a settings file gives it.
struct WrittenSetting {
  std::string key;    // the key of OptionTable
  std::string name;   // the key in the file; the same unless the file has another program's keys
  std::string place;  // FILE:LINE
  // The value for OptionTable::Set(). A quoted number keeps its quotes, so that it is not accepted
  // as a number.
  std::string text = {};
  std::string_view no_value = {};  // what it is ("a list") if it is not a single value
  // Of a map of single values: `name:value` pairs with commas in between.
  std::optional<std::string> pairs = std::nullopt;
};

// The settings of a file in OpenCV's YAML, in their order: `key: value` lines after a first line
// `%YAML:1.0`. Throws InputError with file and line if it is not such a file or gives a key twice.
std::vector<WrittenSetting> ReadYamlSettings(const std::filesystem::path& file);

// The text of the setting. Throws InputError if it is not a single value.
const std::string& SingleValue(const WrittenSetting& setting);

}  // namespace hullslam
