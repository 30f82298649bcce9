// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/geometry/trajectory.h"

namespace hullslam {

// The poses world_from_cam as KITTI's odometry benchmark has them: one line per pose, the first
// three rows of the 4 x 4 matrix, row by row. There are no time stamps.
std::string FormatKittiPoses(const Trajectory& trajectory);

// The poses world_from_cam as a ground truth of EuRoC: a header, then one line per pose with the
// time stamp in whole nanoseconds, the position and the quaternion (w first), separated by commas.
// (EuRoC's own ground truth has the poses of the body, and velocities in further columns.)
std::string FormatEurocPoses(const Trajectory& trajectory);

}  // namespace hullslam
