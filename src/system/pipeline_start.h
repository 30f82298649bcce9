// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/map/map.h"
#include "tracking/pose_source.h"

namespace hullslam {

// What a pipeline begins with.
struct PipelineStart {
  Map map = {};          // of earlier sessions; without keyframes: a new map
  Session session = {};  // that the keyframes of the run will belong to
  // There are no keyframe requests, so nothing in the map is changed.
  bool localization_only = false;
  Relocalise relocalise = nullptr;  // asked while tracking is lost; may be null
};

}  // namespace hullslam
