// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/geometry/trajectory.h"

namespace hullslam {

// A trajectory that another program wrote.
struct PoseFile {
  Trajectory poses;
  bool has_stamps = true;    // false: the stamps are the indices of the rows
  bool has_numbers = false;  // without stamps: these are numbers of frames, and some may be missing
  std::vector<std::string> notes;  // what was converted or skipped
  // Those of live_poses.txt, one for each pose; empty if the file has none. 0 for the poses that
  // the map began with.
  std::vector<Eigen::Matrix<double, 6, 6>> covariances = {};
};

// Reads a trajectory in any of these forms, which the first line with data or a line with the names
// of the columns tells:
// - TUM: timestamp tx ty tz qx qy qz qw; with other columns or with qw first if they are named, as
//   in files of EuRoC and VSLAM-LAB and in those that `export` writes;
// - EuRoC without names: 17 columns;
// - KITTI: the 12 numbers of the first three rows of the matrix world from camera, or all 16. They
//   have no stamps, unless times.txt beside the file has one line for each pose;
// - TartanAir: tx ty tz qx qy qz qw without stamps, of a camera that looks along x with z down;
// - KITTI-360: the same as KITTI behind the number of the frame, without the poses of some frames.
// Stamps may be in seconds, milliseconds, microseconds or nanoseconds. Rows that are malformed or
// go back in time are skipped and counted; of rows with the same stamp, the last one is used.
// Throws InputError if most rows are malformed, or if most stamps repeat the one before with
// another pose, as stamps do that were rounded to seconds.
PoseFile ReadPoseFile(const std::filesystem::path& path);

// The pose with this rotation and translation; absent if the first three columns are no rotation.
// They may be rounded to 2 decimals.
std::optional<Rigid3> PoseOfMatrix(const Eigen::Matrix<double, 3, 4>& matrix);

// Whether a file without stamps has the poses of that many frames.
bool FitsFrames(const PoseFile& file, size_t frames);

// Gives the poses of a file without stamps the stamps of the frames. Throws InputError unless
// FitsFrames().
void SetStamps(const std::filesystem::path& path, std::span<const double> stamps, PoseFile& file);

}  // namespace hullslam
