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

}  // namespace hullslam
