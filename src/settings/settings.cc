// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/settings/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "settings/settings_orb_slam3.h"
#include "settings/yaml_settings.h"
#include "util/shown_text.h"
#include "util/trim.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr std::array kIntrinsics = {"Camera.fx", "Camera.fy", "Camera.cx", "Camera.cy"};

// The text of Camera.fy for the option table. If negative values are allowed, their sign is
// removed.
std::string FocalLengthInY(const WrittenSetting& setting, std::string text,
                           NegativeFy negative_fy) {
  double value = 0.0;
  if (!ParseFinite(text, value) || value >= 0.0) {
    return text;
  }
  if (negative_fy == NegativeFy::kError) {
    throw InputError(fmt::format(
        "{}: {} is '{}', expected a positive number: a camera whose y axis points up makes a "
        "mirrored world. The pixels are the same with {:g}; the ground truth must be mirrored, as "
        "rgbd_icl does",
        setting.origin, setting.name, text, -value));
  }
  return text.substr(text.find('-') + 1);
}

void ApplyFile(const fs::path& file, NegativeFy negative_fy, OptionTable& table,
               std::set<std::string>& given) {
  for (const WrittenSetting& setting : TranslateOrb3Settings(ReadYamlSettings(file))) {
    const bool is_renamed = setting.name != setting.key;
    if (!given.insert(setting.key).second) {
      throw InputError(
          fmt::format("{}: {} was given before under another name", setting.origin, setting.name));
    }
    if (table.SkipRetired(setting.key, setting.origin)) {
      continue;
    }
    // The value is only checked if the key is known, so that an unknown key is reported as such.
    std::string text;
    if (table.IsMap(setting.key) && setting.pairs) {
      text = *setting.pairs;
    } else if (table.Contains(setting.key)) {
      text = SingleValue(setting);
    }
    if (setting.key == "Camera.fy") {
      text = FocalLengthInY(setting, std::move(text), negative_fy);
    }
    table.Set(setting.key, text,
              is_renamed ? fmt::format("{}: {}", setting.origin, setting.name) : setting.origin);
  }
}

void ApplyOverrides(std::span<const std::string> overrides, OptionTable& table,
                    std::set<std::string>& given) {
  for (const std::string_view assignment : overrides) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
      throw InputError(fmt::format("--set: '{}', expected key=value", ShowText(assignment)));
    }
    const std::string key(Trim(assignment.substr(0, equals)));
    table.Set(key, std::string(Trim(assignment.substr(equals + 1))), "--set");
    given.insert(key);
  }
}

void HandOver(const OptionTable& table, std::vector<std::string>* warnings) {
  if (warnings != nullptr) {
    *warnings = table.warnings();
  }
}

// The number of the TUM camera in a name, such as "rgbd_dataset_freiburg1_xyz" or "fr1_desk"; 0 if
// there is none.
int TumCamera(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string_view mark : {"freiburg", "fr"}) {
    const size_t at = name.find(mark);
    const size_t digit = at + mark.size();
    const bool begins_word = at == 0 || (at != std::string::npos && !std::isalnum(name[at - 1]));
    const bool is_camera =
        begins_word && digit < name.size() && name[digit] >= '1' && name[digit] <= '3';
    if (is_camera && (digit + 1 == name.size() || !std::isdigit(name[digit + 1]))) {
      return name[digit] - '0';
    }
  }
  return 0;
}

std::string FolderName(const fs::path& folder) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(folder, error);
  const fs::path& path = error ? folder : absolute;
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace

SystemOptions ReadSettings(const fs::path& file, std::span<const std::string> overrides,
                           NegativeFy negative_fy, std::vector<std::string>* warnings) {
  SystemOptions options;
  OptionTable table = options.Bind();
  std::set<std::string> given;
  ApplyFile(file, negative_fy, table, given);
  ApplyOverrides(overrides, table, given);
  for (const char* const key : kIntrinsics) {
    if (!given.contains(key)) {
      throw InputError(file.string() + ": " + key +
                       " is not given, expected the intrinsics of the camera in px");
    }
  }
  options.Validate();
  HandOver(table, warnings);
  return options;
}

SystemOptions MakeSettings(const CameraCalibration& calibration, const std::string& source,
                           std::span<const std::string> overrides,
                           std::vector<std::string>* warnings) {
  SystemOptions options;
  OptionTable table = options.Bind();
  SystemOptions given;
  given.camera = calibration.camera;
  given.frames_per_second = calibration.frames_per_second;
  // Each value is set as if a file had it, so that its range is checked.
  for (const OptionTable::Entry& entry : given.Bind().Entries()) {
    if (entry.key.starts_with("Camera.")) {
      table.Set(entry.key, entry.value, source);
    }
  }
  if (const std::string fault = calibration.camera.FindFault(); !fault.empty()) {
    throw InputError(source + ": " + fault);
  }
  std::set<std::string> changed;
  ApplyOverrides(overrides, table, changed);
  options.Validate();
  HandOver(table, warnings);
  return options;
}

fs::path FindDefaultSettings(const fs::path& sequence, const fs::path& config_folder) {
  std::error_code error;
  fs::path own = sequence / "camera.yaml";
  if (fs::exists(own, error)) {
    return own;
  }
  const std::string name = FolderName(sequence);
  const int camera = TumCamera(name);
  if (camera == 0) {
    throw InputError(
        fmt::format("{}: the name '{}' does not contain a known camera and there is no "
                    "camera.yaml in the folder, expected --settings FILE",
                    sequence.string(), name));
  }
  return config_folder / fmt::format("TUM{}.yaml", camera);
}

fs::path FindConfigFolder() {
  std::error_code error;
  // Nothing in this library changes the environment, so reading it is safe.
  // NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* const chosen = std::getenv("HULLSLAM_CONFIG");
  if (chosen != nullptr && *chosen != '\0') {
    if (!fs::is_directory(chosen, error)) {
      throw InputError(std::string("HULLSLAM_CONFIG: '") + chosen + "' is not a folder");
    }
    return chosen;
  }
  for (const char* const folder : {HULLSLAM_INSTALLED_CONFIG, HULLSLAM_SOURCE_CONFIG}) {
    if (fs::is_directory(folder, error)) {
      return folder;
    }
  }
  throw InputError(
      fmt::format("neither {} nor {} is a folder, expected the settings of known "
                  "cameras there; set HULLSLAM_CONFIG or give --settings FILE",
                  HULLSLAM_INSTALLED_CONFIG, HULLSLAM_SOURCE_CONFIG));
}

std::string FormatSettings(SystemOptions options) {
  std::string text = "%YAML:1.0\n";
  for (const OptionTable::Entry& entry : options.Bind().Entries()) {
    if (entry.is_shared) {
      continue;
    }
    const bool is_plain = !entry.value.empty() && entry.value.find(':') == std::string::npos;
    text += is_plain ? fmt::format("{}: {}\n", entry.key, entry.value)
                     : fmt::format("{}: \"{}\"\n", entry.key, entry.value);
  }
  return text;
}

std::string HashSettings(const SystemOptions& options) {
  uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char byte : FormatSettings(options)) {
    hash = (hash ^ byte) * 0x100000001b3;
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace hullslam
