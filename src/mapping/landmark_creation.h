// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/mapping/mapping_options.h"

namespace hullslam {

// Makes landmarks of keypoints of `keyframe` and of its best covisible keyframes that match and
// show no landmark yet. They are triangulated if the parallax is larger than that of the virtual
// stereo pair (Mur-Artal and Tardos 2017), and located by depth otherwise. Returns the new
// landmarks.
std::vector<LandmarkId> CreateLandmarks(Map& map, KeyframeId keyframe, const Sensor& sensor,
                                        MappingRule rule = MappingRule::kHullslam);

// Merges landmarks that are the same point. The landmarks of `keyframe` are searched by projection
// in its covisible keyframes and in those covisible with these, and the landmarks of all of them in
// `keyframe`. If the keypoint found shows another landmark, the one with the smaller observation
// weight is replaced; otherwise the keypoint becomes an observation. Then the covisibility of
// `keyframe` is updated.
void FuseLandmarks(Map& map, KeyframeId keyframe, const Sensor& sensor);

}  // namespace hullslam
