// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/objects/object_view.h"

namespace hullslam {

// The last `count` views of an object by increasing keyframe id, or all if it has fewer. They are
// valid until the map changes.
std::vector<ObjectView> LatestViews(const Map& map, const ObjectLandmark& object, size_t count);

}  // namespace hullslam
