// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/util/cancellation.h"

namespace hullslam {

// Bundle adjustment of the whole map, one island after the other. To be called after a loop was
// closed. The correction moves all keyframes and landmarks; objects follow their keyframes. Null if
// `cancellation` (may be null) was requested, or if the solver failed.
std::optional<MapCorrection> AdjustWholeMap(const Map& map, const Sensor& sensor,
                                            const ObjectOptions& objects,
                                            const Cancellation* cancellation);

}  // namespace hullslam
