// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "settings/yaml_settings.h"

namespace hullslam {

// Settings files of ORB-SLAM3 (Campos et al., "ORB-SLAM3", IEEE Transactions on Robotics 37(6),
// 2021). The keys are from its format 1.0 and from the files before it, as the settings files of
// its public examples and its calibration tutorial show them.

// Replaces ORB-SLAM3's keys by ours. Settings without a meaning here (viewer, IMU) are dropped;
// keys that ORB-SLAM3 does not have stay. If a setting cannot be translated, throws InputError that
// names file, line, key and reason.
std::vector<WrittenSetting> TranslateOrb3Settings(std::vector<WrittenSetting> settings);

}  // namespace hullslam
