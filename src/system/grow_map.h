// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/system/options.h"
#include "hullslam/util/cancellation.h"
#include "mapping/mapper.h"
#include "tracking/tracker.h"

namespace hullslam {

// A step at the end of a run whose images were far apart, before FinishMap: makes keyframes of lost
// frames that are found in the map as it is now, and joins islands (FindJoin), until there are no
// more of either.
void GrowMap(Tracker& tracker, Mapper& mapper, const Sensor& sensor, const SystemOptions& options,
             const Cancellation* cancellation);

}  // namespace hullslam
