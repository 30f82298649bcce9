// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"
#include "report/object_results.h"
#include "scene/scene.h"

namespace hullslam {

// The results of a run, which must outlive the call.
struct RecordedRun {
  std::string writer;  // names the program that writes the file
  const SystemOptions* options = nullptr;
  const Map* map = nullptr;
  const ImageSequence* sequence = nullptr;
  size_t frames = 0;  // the first frames of the sequence, which the run was given
  const Trajectory* trajectory = nullptr;
  const ObjectResults* objects = nullptr;
  const Scene* scene = nullptr;  // of the objects
  // The frames as they were when they were tracked. If there are any, the transforms are theirs and
  // lead over the odometry; else they are the poses of the trajectory.
  std::span<const TrackedFrame> live = {};
};

// Writes the run as an MCAP file with messages of ROS 2 (docs/bags.md), in the order of their
// times. The same results give the same bytes. Returns the number of images that could not be read
// and are not in the file. Throws InputError if the file cannot be written.
size_t WriteRecording(const std::filesystem::path& file, const RecordedRun& run);

}  // namespace hullslam
