// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/loop/loop_options.h"
#include "hullslam/map/map.h"

namespace hullslam {

// How far a camera has travelled and turned.
struct Travel {
  double metres = 0.0;
  double radians = 0.0;
};

// The travel along all keyframes, also culled ones, made between two keyframes of one island.
// Keyframes of other islands are passed over.
Travel TravelBetween(const Map& map, KeyframeId first, KeyframeId last);

// Whether drift on this way can explain that a camera, which was at one pose by tracking, is at
// another one by a loop.
bool CanBeDrift(const Travel& travel, const Rigid3& tracked_cam_from_world,
                const Rigid3& corrected_cam_from_world, const LoopOptions& options);

}  // namespace hullslam
