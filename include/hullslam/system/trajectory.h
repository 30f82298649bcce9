// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

struct StampedPose {
  double timestamp = 0.0;  // seconds
  Rigid3 world_from_cam;
};

// In order of time, one pose a time stamp.
using Trajectory = std::vector<StampedPose>;

}  // namespace hullslam
