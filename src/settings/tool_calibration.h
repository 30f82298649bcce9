// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <yaml-cpp/node/node.h>

#include <filesystem>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/geometry/rigid3.h"
#include "settings/yaml_map.h"

namespace hullslam {

// The cameras of a camchain of Kalibr, the file of TUM-VI's folder `dso`. All functions throw
// InputError with file, line and key.

bool IsCamchain(const YamlMap& file);

// cam0 and cam1. Their poses are T_cn_cnm1 of cam1, from cam0 to cam1, or T_cam_imu
// of both.
StereoCalibration ReadCamchainPair(const YamlMap& file);

// The pose of cam0 on the IMU (T_cam_imu); the identity if it is not given.
Rigid3 ReadImuFromCam0(const YamlMap& file);

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
