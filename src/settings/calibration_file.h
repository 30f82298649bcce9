// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <yaml-cpp/node/node.h>

#include <filesystem>
#include <optional>
#include <string>

#include "hullslam/settings/settings.h"

namespace hullslam {

// The camera of a file that another program wrote.
struct RecognisedCalibration {
  CameraCalibration calibration;
  std::string program;  // such as "a camchain of Kalibr, camera cam0 of 2"
};

// Reads a calibration of OpenCV (camera_matrix, distortion_coefficients), ROS (camera_info yaml),
// Kalibr (camchain.yaml; also of TUM-VI; its first camera), EuRoC and TUM-VI (sensor.yaml),
// stella_vslam (Camera.model, flat or as a map), camodocal (model_type) or Basalt (JSON). Nothing
// for a file with other keys, such as a settings file. Throws InputError with file, line and key
// for a file that is one of these but does not describe a camera that HullSLAM has. `root` is what
// ReadYaml() read from `file`.
std::optional<RecognisedCalibration> RecogniseCalibration(const std::filesystem::path& file,
                                                          const YAML::Node& root);

}  // namespace hullslam
