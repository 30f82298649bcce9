// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/system/options.h"

namespace hullslam {

// A format of files that describe a camera.
enum class CameraFormat {
  kSettings,  // settings of HullSLAM
  kKalibr,    // camchain.yaml of Kalibr
  kColmap,    // cameras.txt of COLMAP
  kRos,       // camera_info of ROS
};

// The names for the command line, in the order of CameraFormat.
std::vector<std::string> CameraFormatNames();

// A setting by its key.
struct NamedSetting {
  std::string key;
  std::string value;
};
// All settings of a camera.
std::vector<NamedSetting> CameraSettings(const PinholeCamera& camera);
// The settings of what is not in the camera itself: the times of rows, and depth images.
std::vector<NamedSetting> ImageTimeSettings(const SystemOptions& options);
// The settings of the right camera of a pair, in the form of ORB-SLAM3. Throws InputError if both
// cameras have different models of the lens.
std::vector<NamedSetting> RightCameraSettings(const StereoCalibration& pair);

// The text of a file that describes the camera. `comments` come first, one line each. `extra` are
// only written as settings. Throws InputError for a lens that the format does not have.
std::string CameraFileText(CameraFormat format, const PinholeCamera& camera,
                           double frames_per_second, std::span<const NamedSetting> extra,
                           std::span<const std::string> comments);

}  // namespace hullslam
