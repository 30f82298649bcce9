// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/loop/loop_options.h"
#include "hullslam/map/map.h"

namespace hullslam {

// The length of a camera's path and the sum of its rotations.
struct Travel {
  double length = 0.0;  // in units of the map
  double radians = 0.0;
};

// The travel along all keyframes, also culled ones, made between two keyframes of one island.
// Keyframes of other islands are skipped.
Travel TravelBetween(const Map& map, KeyframeId first, KeyframeId last);

// The length, in units of the map, that the options mean by a metre. A map with depth has the metre
// as its unit. A map without depth has any unit, so the depth of the scene is used instead: the
// median depth of the landmarks that the keyframe observes.
double MetreOf(const Map& map, KeyframeId keyframe, const Sensor& sensor);

// Whether drift along this way can explain the difference between the tracked pose of a camera and
// its pose by a loop. `metre` is a length in units of the map (MetreOf).
bool CanBeDrift(const Travel& travel, const Rigid3& tracked_cam_from_world,
                const Rigid3& corrected_cam_from_world, double metre, const LoopOptions& options);

}  // namespace hullslam
