// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Joins landmarks that are the same point: those of `keyframe` are searched by projection in its
// neighbours and the neighbours' neighbours, and theirs in `keyframe`. Of two the one with less
// support is replaced; a keypoint that was free observes the landmark from now on. Edges of
// `keyframe` are brought up to date.
void FuseLandmarks(Map& map, KeyframeId keyframe, const Sensor& sensor);

}  // namespace hullslam
