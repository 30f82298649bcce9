// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Merges landmarks that are the same point. The landmarks of `keyframe` are searched by projection
// in its covisible keyframes and in those covisible with these, and the landmarks of all of them in
// `keyframe`. If the keypoint found shows another landmark, the one with the smaller observation
// weight is replaced; otherwise the keypoint becomes an observation. Then the covisibility of
// `keyframe` is updated.
void FuseLandmarks(Map& map, KeyframeId keyframe, const Sensor& sensor);

}  // namespace hullslam
