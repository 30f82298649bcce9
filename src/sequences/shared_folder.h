// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// The true poses of frames.
struct FramePoses {
  Trajectory poses = {};
  bool has_files = false;   // false: the folder has no poses
  size_t missing = 0;       // frames without one
  std::string reason = {};  // of the first frame without one
};

// How a data set without lists names its images, which are all in one folder.
struct SharedFolder {
  const char* data_set;
  const char* folder;  // in the folder of the sequence
  const char* colour;  // a part of the names
  const char* depth;
  // Reads the poses of the frames from the files of the data set.
  FramePoses (*read_poses)(const std::filesystem::path& folder, std::span<const FramePaths> frames,
                           double frames_per_second);
};

// 7-Scenes or Replica, if the folder has images with the names of one of them; else null.
const SharedFolder* FindSharedFolder(const std::filesystem::path& folder);

// The true poses of the frames, whose numbers are their stamps times `frames_per_second`:
// frame-000000.pose.txt of 7-Scenes beside each image, or row i of Replica's traj.txt. Absent if
// there are none. If only some frames have one, a warning says how many, and why not all.
std::optional<Trajectory> ReadSharedPoses(const SharedFolder& shared,
                                          const std::filesystem::path& folder,
                                          std::span<const FramePaths> frames,
                                          double frames_per_second,
                                          std::vector<std::string>& warnings);

}  // namespace hullslam
