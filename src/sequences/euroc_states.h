// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "files/text_rows.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/geometry/trajectory.h"

namespace hullslam {

// The time stamp of a row of EuRoC's CSV files, in seconds. The first column has it in nanoseconds.
// Throws InputError with file and line if it is no whole number >= 0.
double EurocSeconds(const TextRow& row);

// The poses of the camera, from a file with the poses of the body. A line has the time stamp, the
// position p (m), the rotation q (w first), and further columns that are not used. Throws
// InputError with file and line if a line is malformed or a stamp does not increase.
Trajectory ReadEurocStates(const std::filesystem::path& file, const Rigid3& body_from_cam);

}  // namespace hullslam
