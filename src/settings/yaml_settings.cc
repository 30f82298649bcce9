// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_settings.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <map>
#include <string_view>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "settings/yaml_map.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// The text of a single value; see WrittenSetting.
std::string SingleText(const YAML::Node& node) {
  const std::optional<double> number = NumberOf(node);
  double in_quotes = 0.0;
  if (!number) {
    return ParseFinite(node.Scalar(), in_quotes) ? '"' + node.Scalar() + '"' : node.Scalar();
  }
  const bool is_whole = std::abs(*number) < 1e15 && *number == std::trunc(*number);
  const bool has_exponent_or_point = node.Scalar().find_first_of(".eE") != std::string::npos;
  // OpenCV writes a whole number as "1000.".
  return is_whole && has_exponent_or_point ? fmt::format("{:.0f}", *number) : node.Scalar();
}

// The pairs of a map; nothing unless all its values are single.
std::optional<std::string> MapText(const YAML::Node& map) {
  std::string text;
  for (const auto& pair : map) {
    if (!pair.first.IsScalar() || !pair.second.IsScalar()) {
      return std::nullopt;
    }
    text +=
        fmt::format("{}{}:{}", text.empty() ? "" : ",", pair.first.Scalar(), pair.second.Scalar());
  }
  return text;
}

WrittenSetting ToSetting(const YAML::Node& key, const YAML::Node& value, const fs::path& file) {
  WrittenSetting setting{.key = key.Scalar(), .name = key.Scalar(), .origin = OriginOf(file, key)};
  if (value.IsNull()) {
    setting.no_value = "empty";
  } else if (value.IsMap() || value.IsSequence()) {
    setting.no_value = value.IsMap() ? "a map" : "a list";
    setting.pairs = value.IsMap() ? MapText(value) : std::nullopt;
  } else {
    setting.text = SingleText(value);
  }
  return setting;
}

}  // namespace

std::vector<WrittenSetting> ReadYamlSettings(const fs::path& file) {
  return ReadYamlSettings(file, ReadYaml(file));
}

std::vector<WrittenSetting> ReadYamlSettings(const fs::path& file, const YAML::Node& root) {
  if (!root.IsMap()) {
    throw InputError(file.string() + ": has no settings, expected lines of 'key: value'" +
                     (file.extension() == ".xml" ? " (OpenCV writes them in a file .yml)" : ""));
  }
  std::vector<WrittenSetting> settings;
  std::map<std::string, int> lines;  // of the keys, from 1
  for (const auto& pair : root) {
    if (!pair.first.IsScalar()) {
      throw InputError(OriginOf(file, pair.first) + ": expected 'key: value'");
    }
    const std::string& key = pair.first.Scalar();
    const auto [first, is_new] = lines.try_emplace(key, pair.first.Mark().line + 1);
    if (!is_new) {
      throw InputError(fmt::format("{}: key '{}' was given before, in line {}",
                                   OriginOf(file, pair.first), ShowText(key), first->second));
    }
    settings.push_back(ToSetting(pair.first, pair.second, file));
  }
  return settings;
}

const std::string& SingleValue(const WrittenSetting& setting) {
  if (!setting.no_value.empty()) {
    throw InputError(fmt::format("{}: {} is {}, expected a single value", setting.origin,
                                 ShowText(setting.name), setting.no_value));
  }
  return setting.text;
}

std::string TextOf(const WrittenSetting& setting, const OptionTable& table) {
  if (table.IsMap(setting.key) && setting.pairs) {
    return *setting.pairs;
  }
  return table.Contains(setting.key) ? SingleValue(setting) : std::string();
}

}  // namespace hullslam
