// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "calibration/calibrate_pair.h"
#include "calibration/determined.h"
#include "calibration/recorded_camera.h"
#include "run/dataset_arguments.h"
#include "settings/camera_file.h"

namespace hullslam {

// What is calibrated, and how.
struct CalibrationRun {
  std::vector<std::filesystem::path> sequences;  // of one camera
  AnyDatasetArguments any = {};
  std::filesystem::path settings = {};  // as in DatasetRequest
  std::vector<std::string> overrides = {};
  std::filesystem::path vocabulary = {};
  FrameSelection selection = {};
  bool is_unknown = false;  // only the size of the images is known of the camera
  int max_passes = 4;
  size_t max_frames = std::numeric_limits<size_t>::max();  // of each sequence
  bool is_quiet = false;
};

// A data set that needs a field of view or settings gets one, which a calibration from nothing does
// not use.
void ChooseAnyFieldOfView(const Dataset& dataset, DatasetChoices& choices);

struct CalibratedRun {
  RecordedCalibration calibration;
  std::optional<PairCalibration> pair;
  // Both cameras of a pair as read, calibrated, if they or the given ones are not rectified.
  std::optional<StereoCalibration> cameras;
  SystemOptions options;  // with the calibrated camera
  std::vector<std::string> sequences;
};

// Calibrates the camera of the sequences. Null, with a message, if it is interrupted. Throws
// InputError for bad input, for cameras of different sizes, and if SLAM finds too little.
std::optional<CalibratedRun> RunCalibration(const CalibrationRun& run);

// key=value for --set, with all numbers of the camera.
std::vector<std::string> OverridesOf(const SystemOptions& options);

}  // namespace hullslam
