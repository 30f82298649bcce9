// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/preset_comparison.h"

#include <fmt/format.h>

namespace hullslam {
namespace {

std::map<std::string, std::string> ValuesOf(const OptionTable& table) {
  std::map<std::string, std::string> values;
  for (OptionTable::Entry& entry : table.Entries()) {
    values.emplace(std::move(entry.key), std::move(entry.value));
  }
  return values;
}

}  // namespace

PresetComparison::PresetComparison(const Preset& preset, OptionTable& table) : preset_(preset) {
  for (const PresetSetting& setting : preset.settings) {
    table.Set(setting.key, setting.value, setting.origin);
  }
  const std::map<std::string, std::string> all = ValuesOf(table);
  for (const PresetSetting& setting : preset.settings) {
    for (const std::string& key : table.KeysSetBy(setting.key)) {
      if (const auto it = all.find(key); it != all.end()) {
        values_.insert(*it);
      }
    }
  }
}

std::vector<PresetOverride> PresetComparison::FindOverrides(
    const OptionTable& table, const std::map<std::string, std::string>& origins) const {
  std::vector<PresetOverride> overrides;
  const std::map<std::string, std::string> now = ValuesOf(table);
  for (const auto& [key, value] : values_) {
    const auto origin = origins.find(key);
    if (now.at(key) != value && origin != origins.end()) {
      overrides.push_back({key, value, now.at(key), origin->second});
    }
  }
  return overrides;
}

std::string Describe(const PresetOverride& replaced, const Preset& preset) {
  return fmt::format("{}: {} is {}, but the preset {} has {}; the value of the file counts",
                     replaced.origin, replaced.key, replaced.value, preset.name,
                     replaced.preset_value);
}

}  // namespace hullslam
