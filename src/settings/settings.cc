// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/settings/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "camera/named_lens.h"
#include "files/paths.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "settings/calibration_file.h"
#include "settings/preset_comparison.h"
#include "settings/resize_settings.h"
#include "settings/settings_orb_slam3.h"
#include "settings/stereo_settings.h"
#include "settings/yaml_map.h"
#include "settings/yaml_settings.h"
#include "util/hash.h"
#include "util/text.h"

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

// The options of a run while they are being set.
class SettingsInProgress {
 public:
  explicit SettingsInProgress(const SettingsSources& sources)
      : sources_(sources), table_(options_.Bind()) {
    if (sources.preset != nullptr) {
      comparison_.emplace(*sources.preset, table_);
      for (const PresetSetting& setting : sources.preset->settings) {
        given_.insert(setting.key);
      }
    }
  }

  void Set(const std::string& key, const std::string& value, const std::string& origin) {
    table_.Set(key, value, origin);
    given_.insert(key);
    for (const std::string& changed : table_.KeysSetBy(key)) {
      origins_[changed] = origin;
    }
  }
  void ApplyFile(const fs::path& file, const YAML::Node& root);
  void ApplyCalibration(const CameraCalibration& calibration, const std::string& source);
  void ApplyOverrides();
  bool IsGiven(const std::string& key) const { return given_.contains(key); }
  // The steps after all settings were set: follows the size of the image and validates the
  // options.
  SystemOptions Finish(SettingsNotes& report);

 private:
  std::string FollowImage();
  std::string FollowShutter();
  void NoteOverrides(SettingsNotes& report) const;

  const SettingsSources& sources_;
  SystemOptions options_;
  OptionTable table_;
  ResizeSettings resize_;
  std::optional<PresetComparison> comparison_;
  std::set<std::string> given_;                 // keys that were set, also by the preset
  std::map<std::string, std::string> origins_;  // of the keys that were set since the preset
};

void SettingsInProgress::ApplyFile(const fs::path& file, const YAML::Node& root) {
  std::set<std::string> in_file;
  for (const WrittenSetting& setting : TranslateOrb3Settings(ReadYamlSettings(file, root))) {
    if (IsStereoKey(setting.key)) {
      continue;  // read by MakeRectifier()
    }
    const bool is_renamed = setting.name != setting.key;
    if (!in_file.insert(setting.key).second) {
      throw InputError(
          fmt::format("{}: {} was given before under another name", setting.origin, setting.name));
    }
    if (resize_.Take(setting.key, setting.text, setting.origin)) {
      continue;
    }
    std::string text = TextOf(setting, table_);
    if (setting.key == "Camera.fy") {
      text = FocalLengthInY(setting, std::move(text), sources_.negative_fy);
    }
    Set(setting.key, text,
        is_renamed ? fmt::format("{}: {}", setting.origin, setting.name) : setting.origin);
  }
}

// Each value is set as if a file had it, so that its range is checked. Most calibrations have no
// baseline; the default of the camera is not one of theirs.
void SettingsInProgress::ApplyCalibration(const CameraCalibration& calibration,
                                          const std::string& source) {
  SystemOptions given;
  given.camera = calibration.camera;
  given.frames_per_second = calibration.frames_per_second;
  for (const OptionTable::Entry& entry : given.Bind().Entries()) {
    const bool is_default_baseline =
        entry.key == "Camera.bf" && calibration.camera.bf == PinholeCamera().bf;
    if (entry.key.starts_with("Camera.") && !is_default_baseline) {
      Set(entry.key, entry.value, source);
    }
  }
  if (const std::string fault = calibration.camera.FindFault(); !fault.empty()) {
    throw InputError(source + ": " + fault);
  }
}

void SettingsInProgress::ApplyOverrides() {
  for (const std::string_view assignment : sources_.overrides) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
      throw InputError(fmt::format("{}: '{}', expected key=value", sources_.overrides_origin,
                                   ShowText(assignment)));
    }
    const std::string key(Trim(assignment.substr(0, equals)));
    const std::string value(Trim(assignment.substr(equals + 1)));
    if (!resize_.Take(key, value, sources_.overrides_origin)) {
      Set(key, value, sources_.overrides_origin);
    }
  }
}

// Fits the features to the size of the images where `given` does not set them. Returns a warning,
// or nothing. A pyramid with too many levels gets fewer: settings files are copied from camera to
// camera with this number, which says nothing about the camera.
std::string SettingsInProgress::FollowImage() {
  const int width = options_.camera.width;
  const int height = options_.camera.height;
  FeatureOptions& features = options_.features;
  std::string warning;
  if (!IsGiven("ORBextractor.nLevels")) {
    features.level_count = features.LevelsFor(width, height);
  } else if (const int most = features.MostLevels(width, height);
             most > 0 && features.level_count > most) {
    warning = fmt::format(
        "ORBextractor.nLevels is {}, but images of {}x{} px are too small for more than {} levels; "
        "{} are used",
        features.level_count, width, height, most, most);
    features.level_count = most;
  }
  if (!IsGiven("ORBextractor.nFeatures")) {
    features.feature_count = features.FeaturesFor(width, height);
  }
  return warning;
}

// Without correction of the shutter, all images count as exposed at once. Returns a warning if a
// user asks for something else at the same time, or nothing.
std::string SettingsInProgress::FollowShutter() {
  if (options_.tracking.correct_shutter || options_.readout_time == 0.0) {
    return {};
  }
  options_.readout_time = 0.0;
  const auto origin = origins_.find("Camera.readout_time");
  return origin != origins_.end() && origin->second == sources_.overrides_origin
             ? sources_.overrides_origin +
                   ": Camera.readout_time has no effect, because tracking.correct_shutter is false"
             : std::string();
}

void SettingsInProgress::NoteOverrides(SettingsNotes& report) const {
  if (!comparison_) {
    return;
  }
  report.preset_overrides = comparison_->FindOverrides(table_, origins_);
  for (const PresetOverride& replaced : report.preset_overrides) {
    if (replaced.origin != sources_.overrides_origin) {
      report.warnings.push_back(Describe(replaced, *sources_.preset));
    }
  }
}

SystemOptions SettingsInProgress::Finish(SettingsNotes& report) {
  if (const PinholeCamera read = options_.camera; resize_.Changes(read)) {
    report.read_width = read.width;
    report.read_height = read.height;
    options_.camera = resize_.Resized(read);
  }
  const std::string of_image = FollowImage();
  const std::string of_shutter = FollowShutter();
  options_.Validate();
  report.warnings.clear();
  NoteOverrides(report);
  report.has_baseline = IsGiven("Camera.bf");
  for (const std::string& warning : {of_image, of_shutter}) {
    if (!warning.empty()) {
      report.warnings.push_back(warning);
    }
  }
  return options_;
}

// The number of the TUM camera in a name, such as "rgbd_dataset_freiburg1_xyz" or "fr1_desk"; 0 if
// there is none.
int TumCamera(std::string name) {
  name = LowerCase(name);
  for (const std::string_view mark : {"freiburg", "fr"}) {
    const size_t at = name.find(mark);
    const size_t digit = at + mark.size();
    const bool begins_word =
        at == 0 || (at != std::string::npos && !(IsDigit(name[at - 1]) || IsLetter(name[at - 1])));
    const bool is_camera =
        begins_word && digit < name.size() && name[digit] >= '1' && name[digit] <= '3';
    if (is_camera && (digit + 1 == name.size() || !IsDigit(name[digit + 1]))) {
      return name[digit] - '0';
    }
  }
  return 0;
}

// The share of the pixels of the image that are used, 0 to 1, by a sample of them.
double SeenShare(const PinholeCamera& camera) {
  constexpr int kSteps = 128;
  int seen = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Eigen::Vector2d cell((j + 0.5) / kSteps, (i + 0.5) / kSteps);
      seen += camera.SeesRaw({cell.x() * camera.width, cell.y() * camera.height}) ? 1 : 0;
    }
  }
  return static_cast<double>(seen) / (kSteps * kSteps);
}

// Empty for a settings file with a lens that needs no mention.
std::string DescribeCamera(const std::string& program, const PinholeCamera& camera) {
  const bool is_usual =
      !camera.IsFisheye() && camera.k4 == 0.0 && camera.k5 == 0.0 && camera.k6 == 0.0;
  if (program.empty() && is_usual) {
    return {};
  }
  const double seen = camera.IsFisheye() ? SeenShare(camera) : 1.0;
  return fmt::format(
      "{}{}x{} px, {}{}", program.empty() ? "" : program + ": ", camera.width, camera.height,
      DescribeLens(camera),
      seen < 1.0 ? fmt::format("; {:.0f} % of the image is used, up to 80 degrees from the axis",
                               100.0 * seen)
                 : "");
}

std::string FolderName(const fs::path& folder) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(folder, error);
  const fs::path& path = error ? folder : absolute;
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace

SystemOptions ReadSettings(const fs::path& file, const SettingsSources& sources,
                           SettingsNotes& report) {
  SettingsInProgress settings(sources);
  const YAML::Node root = ReadYaml(file);
  const std::optional<RecognisedCalibration> recognised = RecogniseCalibration(file, root);
  if (recognised) {
    settings.ApplyCalibration(recognised->calibration, file.string());
  } else {
    settings.ApplyFile(file, root);
  }
  settings.ApplyOverrides();
  for (const char* const key : kIntrinsics) {
    if (!settings.IsGiven(key)) {
      throw InputError(file.string() + ": " + key +
                       " is not given, expected the intrinsics of the camera in px");
    }
  }
  SystemOptions options = settings.Finish(report);
  report.camera_note = DescribeCamera(recognised ? recognised->program : "", options.camera);
  return options;
}

SystemOptions ReadSettings(const fs::path& file, std::span<const std::string> overrides,
                           NegativeFy negative_fy, std::vector<std::string>* warnings) {
  SettingsNotes report;
  SystemOptions options =
      ReadSettings(file, {.overrides = overrides, .negative_fy = negative_fy}, report);
  if (warnings != nullptr) {
    *warnings = std::move(report.warnings);
  }
  return options;
}

SystemOptions MakeSettings(const CameraCalibration& calibration, const std::string& source,
                           const SettingsSources& sources, SettingsNotes& report) {
  SettingsInProgress settings(sources);
  settings.ApplyCalibration(calibration, source);
  settings.ApplyOverrides();
  return settings.Finish(report);
}

SystemOptions MakeSettings(const CameraCalibration& calibration, const std::string& source,
                           std::span<const std::string> overrides,
                           std::vector<std::string>* warnings) {
  SettingsNotes report;
  SystemOptions options = MakeSettings(calibration, source, {.overrides = overrides}, report);
  if (warnings != nullptr) {
    *warnings = std::move(report.warnings);
  }
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
  return FindData("config",
                  "expected the settings of known cameras there; set HULLSLAM_CONFIG or give "
                  "--settings FILE");
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
  return fmt::format("{:016x}", Fnv1a<uint64_t>(FormatSettings(options)));
}

}  // namespace hullslam
