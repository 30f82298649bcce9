// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/load_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <system_error>
#include <utility>

#include "hullslam/util/error.h"
#include "run/messages.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOwn = "in the folder of the sequence";

// The names of the presets for --help. Help must also work without the folder of presets.
std::string ListPresets() {
  try {
    return fmt::format("{}", fmt::join(PresetNames(), ", "));
  } catch (const InputError&) {
    return "a name of config/presets";
  }
}

std::optional<Preset> ReadPresetIfGiven(const std::string& preset) {
  return preset.empty() ? std::nullopt : std::optional(ReadPreset(preset));
}

SettingsSources SourcesOf(const LoadedSettings& settings, std::span<const std::string> overrides,
                          NegativeFy negative_fy) {
  return {.preset = settings.preset ? &*settings.preset : nullptr,
          .overrides = overrides,
          .negative_fy = negative_fy};
}

void TakeNotes(SettingsNotes report, LoadedSettings& settings) {
  for (const std::string& warning : report.warnings) {
    PrintError("warning: {}\n", warning);
  }
  settings.camera_note = std::move(report.camera_note);
  settings.read_width = report.read_width;
  settings.read_height = report.read_height;
  settings.has_baseline = report.has_baseline;
  settings.preset_overrides = std::move(report.preset_overrides);
}

}  // namespace

SettingsChoice ChooseTumSettings(const fs::path& given, const fs::path& sequence) {
  if (!given.empty()) {
    return GivenSettings(given);
  }
  fs::path found = FindDefaultSettings(sequence, FindConfigFolder());
  const bool is_own = found == sequence / "camera.yaml";
  return {std::move(found), is_own ? kOwn : "by the name of the folder of the sequence"};
}

SettingsChoice ChooseIclSettings(const fs::path& given, const fs::path& sequence) {
  std::error_code error;
  if (!given.empty()) {
    return GivenSettings(given);
  }
  if (fs::path own = sequence / "camera.yaml"; fs::exists(own, error)) {
    return {std::move(own), kOwn};
  }
  return {FindConfigFolder() / "ICL.yaml", "the camera of ICL-NUIM"};
}

SettingsChoice GivenSettings(const fs::path& given) { return {given, "as --settings says"}; }

std::string Describe(const SettingsChoice& choice) {
  return fmt::format("settings: {} ({})", choice.file.string(), choice.reason);
}

void AddSettingsArgument(CLI::App& app, const std::string& rule, std::filesystem::path& settings) {
  app.add_option("--settings", settings, "settings file (" + rule + ")");
}

void AddPresetArgument(CLI::App& app, std::string& preset) {
  app.add_option("--preset", preset,
                 "work as a published system does: " + ListPresets() +
                     "; or a FILE that ends in .yaml. The settings file and --set replace its "
                     "settings")
      ->type_name("NAME|FILE");
}

LoadedSettings LoadSettings(const std::filesystem::path& file, const std::string& preset,
                            std::span<const std::string> overrides, NegativeFy negative_fy) {
  LoadedSettings settings{.options = {}, .preset = ReadPresetIfGiven(preset)};
  SettingsNotes report;
  settings.options = ReadSettings(file, SourcesOf(settings, overrides, negative_fy), report);
  TakeNotes(std::move(report), settings);
  return settings;
}

LoadedSettings LoadSettings(const CameraCalibration& calibration, const std::string& source,
                            const std::string& preset, std::span<const std::string> overrides) {
  LoadedSettings settings{.options = {}, .preset = ReadPresetIfGiven(preset)};
  SettingsNotes report;
  settings.options =
      MakeSettings(calibration, source, SourcesOf(settings, overrides, NegativeFy::kError), report);
  TakeNotes(std::move(report), settings);
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
  for (const PresetOverride& replaced : settings.preset_overrides) {
    if (replaced.origin == "--set") {
      text += fmt::format("\n  --set {}={} replaces {}", replaced.key, replaced.value,
                          replaced.preset_value);
    }
  }
  return text;
}

void AddPreset(const LoadedSettings& settings, ProvenanceSummary& provenance) {
  if (!settings.preset) {
    return;
  }
  provenance.preset = settings.preset->name;
  for (const PresetOverride& replaced : settings.preset_overrides) {
    provenance.preset_overrides.push_back({.key = replaced.key,
                                           .preset_value = replaced.preset_value,
                                           .value = replaced.value,
                                           .source = replaced.origin});
  }
}

}  // namespace hullslam
