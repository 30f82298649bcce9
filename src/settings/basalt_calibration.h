// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <yaml-cpp/node/node.h>

#include <filesystem>

#include "hullslam/frame/stereo_rectifier.h"

namespace hullslam {

// Calibrations of Basalt are JSON, which YAML contains: value0 with `intrinsics`, `resolution` and
// T_imu_cam, a list of cameras each.
bool IsBasalt(const YAML::Node& root);

// The camera of this index. `root` is what ReadYaml() read from `file`. Throws InputError with
// file, line and key.
PinholeCamera ReadBasaltCamera(const std::filesystem::path& file, const YAML::Node& root,
                               size_t index);

// The first two cameras.
StereoCalibration ReadBasaltPair(const std::filesystem::path& file, const YAML::Node& root);

}  // namespace hullslam
