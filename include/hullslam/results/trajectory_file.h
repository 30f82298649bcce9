// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/messages.h"
#include "hullslam/util/eigen_alignment.h"

namespace hullslam {

// Reads a trajectory in TUM's format: one line `timestamp tx ty tz qx qy qz qw` per pose (s, m,
// world from camera). Throws InputError with file and line for a line without eight finite numbers,
// for a position beyond 1e8 m, for a quaternion whose length is not between 0.001 and 1000, for
// decreasing time stamps, and for a file without poses. If poses have the same stamp, as in TUM's
// own ground truth, the last one is used (as in TUM's tools).
Trajectory ReadTrajectory(const std::filesystem::path& path);

// The same for keyframes.txt of a run: keyframes of earlier sessions come first, so stamps may
// begin again, and every row is kept.
Trajectory ReadKeyframes(const std::filesystem::path& path);

// The trajectory in TUM's format: stamps with 6 decimals, values with 9, qw not negative. The same
// poses give the same bytes. Throws CheckError for values that are not finite.
std::string FormatTrajectory(const Trajectory& trajectory);

// live_poses.txt (docs/outputs.md): the pose of each tracked frame as it was then, its covariance,
// and its odometry. Reads as a trajectory too, because a first line names the columns.
std::string FormatLivePoses(std::span<const TrackedFrame> frames);

// Writes the trajectory in TUM's format. The file is complete or not there at all. Throws
// InputError with `path` and the reason if it cannot be written.
void WriteTrajectory(const std::filesystem::path& path, const Trajectory& trajectory);

// A part of the poses in a file. Time stamps may begin again from part to part.
struct TrajectoryPart {
  std::string title;  // written in printable ASCII, and cut if it is long; empty: none
  Trajectory poses;
};
// The same with a comment line "# TITLE" before each part that has a title. Readers skip it.
std::string FormatTrajectory(std::span<const TrajectoryPart> parts);

}  // namespace hullslam
