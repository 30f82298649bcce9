// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "settings/yaml_settings.h"

namespace hullslam {

// Settings files of ORB-SLAM3 (Campos et al., "ORB-SLAM3", IEEE Transactions on Robotics 37(6),
// 2021). The keys are those of its format 1.0, as the settings files of its public examples and its
// calibration tutorial show them.

// The settings with ORB-SLAM3's keys replaced by ours. What has no meaning here (viewer, IMU, loop
// closing) is dropped; keys that ORB-SLAM3 does not have stay. Throws InputError that names place,
// key and reason for what cannot be translated.
std::vector<WrittenSetting> TranslateOrb3Settings(std::vector<WrittenSetting> settings);

}  // namespace hullslam
