// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Triangulates keypoints of `keyframe` that are no landmarks yet with those of its best covisible
// keyframes, and takes depth where the parallax is smaller than that of the virtual stereo pair
// (Mur-Artal and Tardos 2017). Returns the new landmarks.
std::vector<LandmarkId> CreateLandmarks(Map& map, KeyframeId keyframe, const Sensor& sensor);

}  // namespace hullslam
