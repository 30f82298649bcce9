// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Removes of the `recent` landmarks those that were found in less than a quarter of the frames they
// should have been seen in, or that are still held by too little two keyframes after they came
// (Mur-Artal and Tardos 2015, section VI.B). What is gone, or has stood the test for three
// keyframes, leaves the list.
void CullRecentLandmarks(Map& map, KeyframeId current, std::vector<LandmarkId>& recent);

// Removes those of the keyframes covisible with `current` nine tenths of whose close landmarks are
// seen by three others at the same or a finer level (section VI.E). Returns how many.
int CullKeyframes(Map& map, KeyframeId current, const Sensor& sensor);

}  // namespace hullslam
