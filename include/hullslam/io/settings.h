// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "hullslam/system/options.h"

namespace hullslam {

// Reads a settings file of ORB-SLAM2's form (OpenCV YAML, flat `key: value` lines under a first
// line `%YAML:1.0`), then applies `overrides` of the form `key=value`, then validates. Keys that
// are in neither keep their defaults; Camera.fx, fy, cx and cy have none. Throws InputError that
// names file, line, key, value and what was expected.
SystemOptions ReadSettings(const std::filesystem::path& file,
                           std::span<const std::string> overrides = {});

// The settings file for a sequence that none was given for: the folder's own `camera.yaml`, else
// the one in `config_folder` of the camera that the folder's name tells (freiburg1 or fr1:
// TUM1.yaml, and so on). Throws InputError that asks for --settings where there is neither.
std::filesystem::path FindDefaultSettings(const std::filesystem::path& sequence,
                                          const std::filesystem::path& config_folder);

// Where the settings of known cameras are: $HULLSLAM_CONFIG, else the folder of the installation,
// else that of the source tree. Throws InputError where none of them is a folder.
std::filesystem::path FindConfigFolder();

// All settings in use as a file that ReadSettings() reads, sorted by key.
std::string FormatSettings(SystemOptions options);

// 16 hexadecimal digits that change when any setting in use does (FNV-1a of FormatSettings()).
std::string HashSettings(const SystemOptions& options);

}  // namespace hullslam
