// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "map/contradictions.h"

namespace hullslam {

// Whether the object has moved away since it was observed last: the depth images of the keyframe
// `current` and of so many earlier ones that they are ChangeOptions::min_keyframes show what is
// behind the object (SeesThrough). So it does not matter how many keyframes have observed it
// before, and a detector that misses it is no reason. To be called once per keyframe and object.
bool IsContradicted(const Map& map, const Sensor& sensor, KeyframeId current, ObjectId id,
                    const ChangeOptions& options, Contradictions<ObjectId>& contradictions);

}  // namespace hullslam
