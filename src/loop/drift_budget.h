// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/loop/loop_options.h"
#include "hullslam/map/map.h"

namespace hullslam {

// The length of a camera's path and the sum of its rotations.
struct Travel {
  double metres = 0.0;
  double radians = 0.0;
};

// The travel along all keyframes, also culled ones, made between two keyframes of one island.
// Keyframes of other islands are skipped.
Travel TravelBetween(const Map& map, KeyframeId first, KeyframeId last);

// Whether drift along this path can explain the difference between the tracked pose of a camera and
// the pose that a loop gives it.
bool CanBeDrift(const Travel& travel, const Rigid3& tracked_cam_from_world,
                const Rigid3& corrected_cam_from_world, const LoopOptions& options);

}  // namespace hullslam
