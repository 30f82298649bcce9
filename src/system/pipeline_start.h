// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/map/map.h"

namespace hullslam {

// The initial state of a pipeline.
struct PipelineStart {
  Map map = {};          // of earlier sessions; a new map if it has no keyframes
  Session session = {};  // the session of the keyframes of this run
  // There are no keyframe requests, so nothing in the map is changed.
  bool localization_only = false;
};

}  // namespace hullslam
