// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "files/text_rows.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/geometry/trajectory.h"

namespace hullslam {

// The time stamp of a row of EuRoC's CSV files: nanoseconds in the first column, as seconds. Throws
// InputError with file and line if it is no whole number >= 0.
double EurocSeconds(const TextRow& row);

// The poses of the camera from a file with those of the body: per line the time stamp, the position
// p (m), the rotation q (w first), and further columns that are not used. Throws InputError with
// file and line.
Trajectory ReadEurocStates(const std::filesystem::path& file, const Rigid3& body_from_cam);

}  // namespace hullslam
