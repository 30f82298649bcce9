// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "map/contradictions.h"

namespace hullslam {

// Removes landmarks of things that have moved away: those that the depth images of the keyframe
// `current` and of two earlier ones contradict. A keyframe contradicts a landmark that it should
// see but does not observe, if every depth around the landmark's projection was measured behind the
// landmark. Something nearer hides the landmark and is no contradiction. If the landmark is
// observed again, or if a depth is that of the landmark, the count begins again. So it does not
// matter how many keyframes have observed it before. Checks the landmarks of all keyframes that are
// covisible with `current`. Returns how many were removed: none without depth. To be called once
// per keyframe.
size_t EraseContradictedLandmarks(Map& map, KeyframeId current, const Sensor& sensor,
                                  Contradictions<LandmarkId>& contradictions);

}  // namespace hullslam
