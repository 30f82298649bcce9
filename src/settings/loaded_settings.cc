// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/settings/loaded_settings.h"

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

}  // namespace hullslam
