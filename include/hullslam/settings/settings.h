// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/settings/preset.h"
#include "hullslam/system/options.h"

namespace hullslam {

// How a negative Camera.fy in a settings file is treated. Some files of other programs have one:
// their y axis points up, so their world is left-handed. A camera with y down and the positive
// value has the same pixels.
enum class NegativeFy {
  kError,
  kPositive,  // the positive value is used; for programs that mirror the ground truth (rgbd_icl)
};

// Reads a settings file in the format of ORB-SLAM2 (OpenCV YAML: `key: value` lines after a first
// line `%YAML:1.0`) or of ORB-SLAM3 (format 1.0, docs/settings.md), or only the camera from a
// calibration of OpenCV, ROS, Kalibr, EuRoC or stella_vslam, then applies `overrides` of the
// form `key=value`, then validates the result. Missing keys keep their defaults; Camera.fx, fy, cx
// and cy have no default. Throws InputError that names file, line, key, value and what was
// expected. If `warnings` is not null, a warning is added for each key that has a new name, and for
// each key of the file that is ignored because it is no setting any more.
SystemOptions ReadSettings(const std::filesystem::path& file,
                           std::span<const std::string> overrides = {},
                           NegativeFy negative_fy = NegativeFy::kError,
                           std::vector<std::string>* warnings = nullptr);

// The settings beside the settings file of a camera, in the order preset, file, overrides.
struct SettingsSources {
  const Preset* preset = nullptr;               // null: none
  std::span<const std::string> overrides = {};  // key=value
  NegativeFy negative_fy = NegativeFy::kError;
  std::string overrides_origin = "--set";  // names the source of the overrides in messages
};

// A setting of a preset that another source has replaced.
struct PresetOverride {
  std::string key;
  std::string preset_value;
  std::string value;
  std::string origin;  // FILE:LINE of the settings file, the name of a calibration, or --set
};

// Messages for the user about the settings.
struct SettingsNotes {
  std::vector<std::string> warnings;             // also one per override by a file or a calibration
  std::vector<PresetOverride> preset_overrides;  // sorted by key
  // What the file was recognised as, if it is no settings file, and any lens other than Brown's.
  std::string camera_note;
  // The size of the images as read, px, if they are to be resized (Camera.newWidth); else 0. The
  // camera describes the resized images.
  int read_width = 0;
  int read_height = 0;
  bool has_baseline = false;  // whether any of the sources has Camera.bf
};

// The same with a preset, whose settings the file and the overrides replace.
SystemOptions ReadSettings(const std::filesystem::path& file, const SettingsSources& sources,
                           SettingsNotes& report);

// A camera as its calibration or its data set describes it.
struct CameraCalibration {
  PinholeCamera camera;
  double frames_per_second = 30.0;
};

// The settings for a camera without a settings file: the defaults, then `overrides` as in
// ReadSettings(), with the same warnings. Throws InputError if ReadSettings() would refuse such a
// file. `source` names the origin of the calibration in messages.
SystemOptions MakeSettings(const CameraCalibration& calibration, const std::string& source,
                           std::span<const std::string> overrides = {},
                           std::vector<std::string>* warnings = nullptr);
// The same with a preset, whose settings the calibration and the overrides replace.
SystemOptions MakeSettings(const CameraCalibration& calibration, const std::string& source,
                           const SettingsSources& sources, SettingsNotes& report);

// The default settings file of a sequence: `camera.yaml` in its folder, else the file in
// `config_folder` for the camera that the name of the folder contains (freiburg1 or fr1: TUM1.yaml,
// and so on). Throws InputError that asks for --settings if there is neither.
std::filesystem::path FindDefaultSettings(const std::filesystem::path& sequence,
                                          const std::filesystem::path& config_folder);

// The folder with the settings of known cameras: $HULLSLAM_CONFIG, else the folder of the
// installation, else the one of the source tree. Throws InputError if none of them is a folder.
std::filesystem::path FindConfigFolder();

// All current settings in the format of ReadSettings(), sorted by key.
std::string FormatSettings(SystemOptions options);

// 16 hexadecimal digits that change if any setting changes (FNV-1a of FormatSettings()).
std::string HashSettings(const SystemOptions& options);

}  // namespace hullslam
