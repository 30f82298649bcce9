// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"

namespace hullslam {

struct StampedPose {
  double timestamp = 0.0;  // seconds
  Rigid3 world_from_cam;
};

// In order of time, one pose a time stamp.
using Trajectory = std::vector<StampedPose>;

// Poses of all tracked frames in the map as it is: each hangs on its reference keyframe, that of a
// keyframe is its own. Frames without a pose are left out.
Trajectory ComposeTrajectory(const Map& map, std::span<const TrackedFrame> frames);

// The pose at a time (s) between two of the trajectory's, on the straight line with constant
// rotation; nothing before, after, or in a gap longer than `max_gap` s.
std::optional<Rigid3> InterpolatePose(const Trajectory& trajectory, double timestamp,
                                      double max_gap);

// Poses of the keyframes.
Trajectory KeyframeTrajectory(const Map& map);

}  // namespace hullslam
