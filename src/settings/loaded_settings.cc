// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/settings/loaded_settings.h"

#include <fmt/format.h>

#include <string>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

LoadedSettings WithPreset(const std::string& preset) {
  return {.options = {},
          .preset = preset.empty() ? std::nullopt : std::optional(ReadPreset(preset))};
}

SettingsSources SourcesOf(const LoadedSettings& settings, std::span<const std::string> overrides,
                          NegativeFy negative_fy) {
  return {.preset = settings.preset ? &*settings.preset : nullptr,
          .overrides = overrides,
          .negative_fy = negative_fy};
}

}  // namespace

LoadedSettings LoadSettings(const std::filesystem::path& file, const std::string& preset,
                            std::span<const std::string> overrides, NegativeFy negative_fy) {
  LoadedSettings settings = WithPreset(preset);
  settings.options =
      ReadSettings(file, SourcesOf(settings, overrides, negative_fy), settings.notes);
  return settings;
}

LoadedSettings LoadSettings(const CameraCalibration& calibration, const std::string& source,
                            const std::string& preset, std::span<const std::string> overrides) {
  LoadedSettings settings = WithPreset(preset);
  settings.options = MakeSettings(
      calibration, source, SourcesOf(settings, overrides, NegativeFy::kError), settings.notes);
  return settings;
}

void CheckPresetHasMasks(const LoadedSettings& settings, const std::filesystem::path& masks) {
  if (settings.preset && settings.preset->needs_masks && masks.empty() &&
      settings.options.objects.enabled) {
    throw InputError(fmt::format(
        "--preset: the preset {} needs masks of objects, expected --masks PATH (or --set "
        "objects.enabled=false, which leaves its points only)",
        settings.preset->name));
  }
}

std::string DescribePreset(const LoadedSettings& settings) {
  if (!settings.preset) {
    return {};
  }
  std::string text =
      fmt::format("preset: {} ({})", settings.preset->name, settings.preset->file.string());
  for (const PresetOverride& replaced : settings.notes.preset_overrides) {
    if (replaced.origin == "--set") {
      text += fmt::format("\n  --set {}={} replaces {}", replaced.key, replaced.value,
                          replaced.preset_value);
    }
  }
  return text;
}

}  // namespace hullslam
