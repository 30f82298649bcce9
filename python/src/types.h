// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/instance_mask.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "hullslam/system/options.h"
#include "hullslam/util/error.h"

namespace hullslam::python {

// hullslam.Settings is derived from this class.
struct SettingsTable {
  SystemOptions options;
  std::vector<std::string> warnings;  // what the user should be told about the settings
};

// hullslam.Masks: the instances of one image.
struct MaskList {
  std::vector<InstanceMask> masks;
  cv::Size size = {};  // of the image, px; 0 if it is not known
};

// hullslam.Trajectory
struct PoseList {
  Trajectory poses;
};

// hullslam.Map: a snapshot, which never changes.
struct MapView {
  std::shared_ptr<const Map> map;
  PinholeCamera camera;
};

// The value that belongs to `text`. Throws InputError that starts with `name` and lists the texts
// if it is none of them.
template <typename Value>
Value Choose(const std::string& name, const std::string& text,
             const std::vector<std::pair<std::string, Value>>& choices) {
  std::string expected;
  for (const auto& [choice, value] : choices) {
    if (choice == text) {
      return value;
    }
    expected += (expected.empty() ? "" : ", ") + choice;
  }
  throw InputError(name + " is '" + text + "', expected one of: " + expected);
}

}  // namespace hullslam::python
