// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hullslam/settings/preset.h"
#include "hullslam/settings/settings.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// Remembers the values that a preset has set, to find out later which of them were replaced.
class PresetComparison {
 public:
  // Sets the settings of the preset in the table. The preset must outlive the comparison.
  PresetComparison(const Preset& preset, OptionTable& table);

  // The settings of the preset that now have another value, sorted by key. `origins` tells for each
  // key that was set since then what set it last.
  std::vector<PresetOverride> FindOverrides(
      const OptionTable& table, const std::map<std::string, std::string>& origins) const;

 private:
  const Preset& preset_;
  std::map<std::string, std::string> values_;  // by key
};

// The message for a user about an override by a settings file.
std::string Describe(const PresetOverride& replaced, const Preset& preset);

}  // namespace hullslam
