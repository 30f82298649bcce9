// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hullslam {

// Settings files of ORB-SLAM3 (Campos et al., "ORB-SLAM3", IEEE Transactions on Robotics 37(6),
// 2021). The keys are those of its format 1.0, as the settings files of its public examples and its
// calibration tutorial show them.

// What is done with a setting of ORB-SLAM3.
struct Orb3Setting {
  enum class Kind {
    kRenamed,   // it is our setting `key`
    kIgnored,   // it has no meaning here (viewer, IMU, loop closing)
    kBaseline,  // Stereo.b, the baseline in m; Camera.bf is this times Camera.fx
    kVersion,   // File.version
    kModel,     // Camera.type
    kSize,      // the size to which images are resized; it must be `key`, their own size
    kRefused,   // it cannot be translated, for the reason `why`
  };
  Kind kind = Kind::kIgnored;
  std::string key;
  std::string why;
};

// Absent for a key that ORB-SLAM3 does not have, or that means the same here.
std::optional<Orb3Setting> FindOrb3Setting(std::string_view key);

}  // namespace hullslam
