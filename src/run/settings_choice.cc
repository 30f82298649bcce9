// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/settings_choice.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "hullslam/settings/settings.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOwn = "in the folder of the sequence";

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

}  // namespace hullslam
