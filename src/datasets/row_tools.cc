// SPDX-License-Identifier: GPL-3.0-or-later
#include "datasets/row_tools.h"

#include <fmt/format.h>

#include <system_error>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "settings/stereo_settings.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Rectifier = std::shared_ptr<const StereoRectifier>;

// The rectifier that settings of a stereo camera ask for; null for rectified images.
Rectifier RectifierOfSettings(const fs::path& file, const LoadedSettings& settings,
                              bool replaces_calibration) {
  if (!settings.notes.has_baseline && !HasRightCamera(file)) {
    throw InputError(file.string() +
                     ": has no baseline, expected Camera.bf (the baseline times Camera.fx) or the "
                     "calibration of both cameras");
  }
  const PinholeCamera& camera = settings.options.camera;
  const auto rectifier = MakeRectifier(file, camera);
  if (rectifier != nullptr && settings.notes.read_width > 0) {
    throw InputError(file.string() +
                     ": asks for resized images, which is not possible where both images are "
                     "rectified, expected neither Camera.newWidth, Camera.newHeight nor "
                     "Camera.imageScale");
  }
  return replaces_calibration && rectifier == nullptr ? MakePairRectifier(file, camera) : rectifier;
}

}  // namespace

bool IsThere(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool IsFolderThere(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

std::string TextOf(const DatasetChoices& choices, const std::string& key) {
  const auto found = choices.find(key);
  return found != choices.end() ? found->second : std::string();
}

std::optional<double> NumberOf(const DatasetChoices& choices, const std::string& key,
                               const char* origin) {
  const std::string text = TextOf(choices, key);
  double value = 0.0;
  if (text.empty()) {
    return std::nullopt;
  }
  if (!ParseFinite(text, value)) {
    throw InputError(fmt::format("{}{} is '{}', expected a number", key, origin, ShowText(text)));
  }
  return value;
}

std::string DescribeSettings(const fs::path& file, const std::string& reason) {
  return fmt::format("settings: {} ({})", file.string(), reason);
}

std::string DescribeGivenSettings(const fs::path& file) {
  return DescribeSettings(file, "as --settings says");
}

LoadedSettings SettingsOf(const DatasetRequest& request, const CameraCalibration& calibration) {
  return request.settings.empty()
             ? LoadSettings(calibration, request.path.string(), request.preset, request.overrides)
             : LoadSettings(request.settings, request.preset, request.overrides);
}

OpenedDataset OpenPairs(const DatasetRequest& request, const fs::path& file,
                        bool replaces_calibration, const PairOpener& open) {
  OpenedDataset opened;
  Rectifier rectifier;
  if (!file.empty()) {
    opened.settings = LoadSettings(file, request.preset, request.overrides);
    rectifier = RectifierOfSettings(file, opened.settings, replaces_calibration);
  }
  CameraCalibration calibration = open(rectifier, opened);
  if (!request.settings.empty()) {
    opened.notes.push_back(DescribeGivenSettings(request.settings));
  }
  if (!file.empty() && rectifier == nullptr) {
    return opened;  // the images are rectified, and the settings have their camera
  }
  if (rectifier != nullptr) {
    calibration.camera = rectifier->camera();
    opened.sequence.choices["calibration"] = fs::absolute(file).string();
  }
  // The images are rectified to this camera, whose size and numbers are checked.
  const PinholeCamera camera = MakeSettings(calibration, request.path.string()).camera;
  if (file.empty()) {
    opened.settings = SettingsOf(request, calibration);
  }
  opened.settings.options.camera = camera;
  return opened;
}

Rectifier RectifierOfRun(const ImagesRequest& request, bool replaces_calibration) {
  const std::string file = TextOf(request.choices, "calibration");
  if (file.empty()) {
    return nullptr;
  }
  const PinholeCamera camera = ReadSettings(file).camera;
  return replaces_calibration ? MakePairRectifier(file, camera) : MakeRectifier(file, camera);
}

}  // namespace hullslam
