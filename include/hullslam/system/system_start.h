// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/map/map.h"

namespace hullslam {

// The initial state of a System.
struct SystemStart {
  // The map of earlier sessions, for example from ReadMap(), made with the same camera, image
  // pyramid and vocabulary. Tracking is lost until a frame is found in it. A map without keyframes
  // stands for a new map.
  Map map = {};
  std::string session_name = {};  // for Map::sessions(), such as the name of the sequence
  // Whether poses are found in the map without changing anything in it.
  bool localization_only = false;
};

}  // namespace hullslam
