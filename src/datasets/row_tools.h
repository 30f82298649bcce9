// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
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

// Opens the pairs of a data set and adds them and the notes about them. The pairs are rectified by
// this rectifier or, if it is null, by the calibration of the data set, if it has one. Returns that
// calibration, of the rectified images.
using PairOpener = std::function<CameraCalibration(
    const std::shared_ptr<const StereoRectifier>& rectifier, OpenedDataset& opened)>;

// Opens the pairs of any data set. `file` has the settings; empty: the calibration of the data set
// is used. With `replaces_calibration` (MakePairRectifier()), the file replaces such a
// calibration. Throws InputError if the file has no baseline, if it asks for images that are
// rectified and resized, and for a rectified camera that cannot be real.
OpenedDataset OpenPairs(const DatasetRequest& request, const std::filesystem::path& file,
                        bool replaces_calibration, const PairOpener& open);

// The rectifier that OpenPairs() has used, from the choices of a run; null without one.
std::shared_ptr<const StereoRectifier> RectifierOfRun(const ImagesRequest& request,
                                                      bool replaces_calibration);

}  // namespace hullslam
