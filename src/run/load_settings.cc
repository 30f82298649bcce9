// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/load_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "hullslam/util/error.h"
#include "run/messages.h"

namespace hullslam {
namespace {

// The names of the presets for --help. Help must also work without the folder of presets.
std::string ListPresets() {
  try {
    return fmt::format("{}", fmt::join(PresetNames(), ", "));
  } catch (const InputError&) {
    return "a name of config/presets";
  }
}

}  // namespace

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

void PrintSettingsWarnings(const LoadedSettings& settings) {
  for (const std::string& warning : settings.notes.warnings) {
    PrintError("warning: {}\n", warning);
  }
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

void AddPreset(const LoadedSettings& settings, ProvenanceSummary& provenance) {
  if (!settings.preset) {
    return;
  }
  provenance.preset = settings.preset->name;
  for (const PresetOverride& replaced : settings.notes.preset_overrides) {
    provenance.preset_overrides.push_back({.key = replaced.key,
                                           .preset_value = replaced.preset_value,
                                           .value = replaced.value,
                                           .source = replaced.origin});
  }
}

}  // namespace hullslam
