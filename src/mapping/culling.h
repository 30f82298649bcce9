// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Removes `recent` landmarks from the map if they were found in less than a quarter of the frames
// in which they should have been visible, or if their observation weight is still too small two
// keyframes after they were made (Mur-Artal and Tardos 2015, section VI.B). Landmarks that no
// longer exist or that are three keyframes old leave the list.
void CullRecentLandmarks(Map& map, KeyframeId current, std::vector<LandmarkId>& recent);

// Removes redundant keyframes among those covisible with `current`: three other keyframes see nine
// tenths of their close landmarks at the same or a finer level (section VI.E). Returns how many
// were removed.
int CullKeyframes(Map& map, KeyframeId current, const Sensor& sensor);

}  // namespace hullslam
