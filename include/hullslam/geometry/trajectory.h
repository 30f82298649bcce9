// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

struct StampedPose {
  double timestamp = 0.0;  // seconds
  Rigid3 world_from_cam;
};

// Poses in order of time, one per time stamp.
using Trajectory = std::vector<StampedPose>;

// The pose at `timestamp` (seconds), interpolated between its two neighbours in the trajectory: the
// position on a straight line, the rotation at constant angular velocity. Returns nothing before
// the first pose, after the last pose, or in a gap longer than `max_gap` seconds. Stamps that
// differ by less than a microsecond, as files round them, are the same.
std::optional<Rigid3> InterpolatePose(const Trajectory& trajectory, double timestamp,
                                      double max_gap);

// The poses of another camera that is fixed to the camera of the trajectory.
Trajectory OfOtherCamera(Trajectory trajectory, const Rigid3& cam_from_other);

// The time stamps of the poses, s.
std::vector<double> StampsOf(const Trajectory& trajectory);

}  // namespace hullslam
