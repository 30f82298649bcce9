// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "hullslam/geometry/trajectory.h"

namespace hullslam {

// Reads a trajectory in TUM's format, `timestamp tx ty tz qx qy qz qw` a line (s, m, world from
// camera). Throws InputError with file and line for anything but eight finite numbers, for a
// quaternion of zero length, for time that runs backwards and for a file without poses. Of poses
// with the same stamp, as TUM's own ground truth has them, the last one counts (as in TUM's tools).
Trajectory ReadTrajectory(const std::filesystem::path& path);

// The trajectory in TUM's format: stamps with 6 decimals, values with 9, qw not negative. The same
// poses give the same bytes. CheckError for values that are not finite.
std::string FormatTrajectory(const Trajectory& trajectory);

// Writes FormatTrajectory() by WriteFileAtomically().
void WriteTrajectory(const std::filesystem::path& path, const Trajectory& trajectory);

}  // namespace hullslam
