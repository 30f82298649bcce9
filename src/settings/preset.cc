// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/settings/preset.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>

#include "hullslam/settings/settings.h"
#include "hullslam/util/error.h"
#include "settings/yaml_settings.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// The keys that only presets have.
constexpr const char* kBase = "preset.base";
constexpr const char* kNeedsMasks = "preset.needs_masks";

bool IsYamlFile(const fs::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

fs::path PresetFolder() {
  fs::path folder = FindConfigFolder() / "presets";
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string() + " is not a folder, expected the presets there");
  }
  return folder;
}

std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

// The number of first characters that are equal.
size_t CommonBegin(const std::string& a, const std::string& b) {
  const auto ends = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<size_t>(ends.first - a.begin());
}

// The name that is spelled most like `name`, of equal ones the one that begins most like it; empty
// if none is like it.
std::string Nearest(const std::string& name, const std::vector<std::string>& names) {
  std::string nearest;
  size_t least = std::max<size_t>(2, name.size() / 2);
  for (const std::string& known : names) {
    const size_t distance = EditDistance(name, known);
    const bool begins_more_alike = CommonBegin(name, known) > CommonBegin(name, nearest);
    if (distance < least || (distance == least && begins_more_alike)) {
      least = distance;
      nearest = known;
    }
  }
  return nearest;
}

fs::path FileOf(const std::string& name, const std::string& origin) {
  const fs::path folder = PresetFolder();
  const std::vector<std::string> names = NamesIn(folder);
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    return folder / (name + ".yaml");
  }
  constexpr size_t kLongestName = 100;
  const std::string nearest = Nearest(name.substr(0, kLongestName), names);
  throw InputError(fmt::format(
      "{}: there is no preset '{}' in {}, expected one of: {}; or a file that ends in .yaml{}",
      origin, ShowText(name), folder.string(), fmt::join(names, ", "),
      nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

bool ToBool(const WrittenSetting& setting) {
  const std::string& text = SingleValue(setting);
  const bool is_true = text == "1" || text == "true";
  if (!is_true && text != "0" && text != "false") {
    throw InputError(fmt::format("{}: {} is '{}', expected true or false (1 or 0)", setting.origin,
                                 kNeedsMasks, ShowText(text)));
  }
  return is_true;
}

// The base of the preset in `file`. The path of a file is relative to that file. Messages show it,
// so it must be short and printable.
std::string BaseOf(const fs::path& file, const WrittenSetting& setting) {
  constexpr size_t kLongestBase = 500;
  const std::string& base = SingleValue(setting);
  if (base.size() > kLongestBase || std::any_of(base.begin(), base.end(), IsControl)) {
    throw InputError(fmt::format("{}: {} is '{}', expected the name of a preset or a file",
                                 setting.origin, kBase, ShowText(base)));
  }
  const bool is_relative_file = IsYamlFile(base) && fs::path(base).is_relative();
  return is_relative_file ? (file.parent_path() / base).string() : base;
}

// `origin` says who asks for the preset, and `depth` how many presets are based on it.
Preset ReadWithBases(const std::string& name_or_file, const std::string& origin, int depth) {
  constexpr int kMostBases = 10;
  if (depth > kMostBases) {
    throw InputError(
        fmt::format("{}: more than {} presets are based on each other", origin, kMostBases));
  }
  const bool is_file = IsYamlFile(name_or_file);
  const fs::path file = is_file ? fs::path(name_or_file) : FileOf(name_or_file, origin);
  const std::vector<WrittenSetting> written = ReadYamlSettings(file);
  Preset preset;
  const auto base = std::find_if(written.begin(), written.end(),
                                 [](const auto& setting) { return setting.key == kBase; });
  if (base != written.end()) {
    preset =
        ReadWithBases(BaseOf(file, *base), fmt::format("{}: {}", base->origin, kBase), depth + 1);
  }
  preset.file = file;
  preset.name = is_file ? file.stem().string() : name_or_file;
  SystemOptions scratch;
  const OptionTable table = scratch.Bind();
  for (const WrittenSetting& setting : written) {
    if (setting.key == kNeedsMasks) {
      preset.needs_masks = ToBool(setting);
    } else if (setting.key != kBase) {
      preset.settings.push_back({setting.key, TextOf(setting, table), setting.origin});
    }
  }
  return preset;
}

}  // namespace

std::vector<std::string> PresetNames() { return NamesIn(PresetFolder()); }

Preset ReadPreset(const std::string& name_or_file) {
  Preset preset = ReadWithBases(name_or_file, "--preset", 0);
  SystemOptions scratch;
  ApplyPreset(preset, scratch);  // finds what cannot be used
  return preset;
}

void ApplyPreset(const Preset& preset, SystemOptions& options) {
  OptionTable table = options.Bind();
  for (const PresetSetting& setting : preset.settings) {
    table.Set(setting.key, setting.value, setting.origin);
  }
}

}  // namespace hullslam
