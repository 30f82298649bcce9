// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "hullslam/datasets/dataset.h"
#include "hullslam/frame/stereo_rectifier.h"

namespace hullslam {

// What the rows of several data sets share.

// Whether the path exists. Throws nothing.
bool IsThere(const std::filesystem::path& path);
bool IsFolderThere(const std::filesystem::path& path);

// A choice; empty if it is not made.
std::string TextOf(const DatasetChoices& choices, const std::string& key);
// The number of a choice; absent if it is not made. Throws InputError with the key and `origin`
// (ImagesRequest::origin) for anything else.
std::optional<double> NumberOf(const DatasetChoices& choices, const std::string& key,
                               const char* origin = "");

// "settings: FILE (REASON)", which a user sees before a run.
std::string DescribeSettings(const std::filesystem::path& file, const std::string& reason);
std::string DescribeGivenSettings(const std::filesystem::path& file);

// Reads the file of DatasetRequest::settings or, if there is none, takes the calibration.
LoadedSettings SettingsOf(const DatasetRequest& request, const CameraCalibration& calibration);

// The rectifier of a file of settings or of a calibration; null without a file. MakePairRectifier()
// is for data sets whose own calibration the file replaces.
std::shared_ptr<const StereoRectifier> ReadRectifier(const std::string& calibration);
std::shared_ptr<const StereoRectifier> ReadPairRectifier(const std::string& calibration);

// The rectifier that settings of a stereo camera ask for (MakeRectifier(), MakePairRectifier()).
// Throws InputError if they have no baseline, or if they ask for images that are rectified and
// resized.
std::shared_ptr<const StereoRectifier> RectifierOfSettings(const std::filesystem::path& file,
                                                           const LoadedSettings& settings,
                                                           bool replaces_calibration);

}  // namespace hullslam
