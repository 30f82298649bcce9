// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"

namespace hullslam {

// How a map, or a new island of it (Map::BeginIsland), begins. It depends on the sensor.
struct IslandRules {
  // Whether it takes several frames, between which the camera moves. The first frames then have no
  // poses, and those of a young island have uncertain ones, so they are located at the end.
  bool needs_motion = false;
  // Whether a camera that is lost begins a new island.
  bool begins_when_lost = false;

  static IslandRules ForSensor(SensorKind kind) {
    const bool is_monocular = kind == SensorKind::kMonocular;
    // With depth, one frame makes a map. Without depth the first points are triangulated, which
    // needs motion. A lost camera with depth waits until it is found again. A monocular one is lost
    // more often, so it goes on in a new island, which place recognition can join to the others.
    return {.needs_motion = is_monocular, .begins_when_lost = is_monocular};
  }
};

}  // namespace hullslam
