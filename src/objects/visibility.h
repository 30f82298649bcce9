// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// Whether a keyframe should show a mapped object that it does not observe: the whole projected
// ellipse is in the image, the object is not much farther away than it was ever seen, and nothing
// nearer hides it. What hides it is known from the keyframe's depth grid or, without depth, from
// its landmarks, and from the mapped objects that it observes. Where nothing is known, nothing
// hides the object.
bool ShouldShow(const Map& map, const Sensor& sensor, KeyframeId keyframe,
                const ObjectLandmark& object, const ObjectOptions& options);

}  // namespace hullslam
