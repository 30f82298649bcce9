// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/util/cancellation.h"
#include "optim/bundle_result.h"

namespace hullslam {

struct IslandAdjustment {
  BundleResult result;
  std::vector<ObjectId> objects;  // that took part, by increasing id
};

// Global bundle adjustment of an island: of its landmarks, of all its keyframes but the root of the
// spanning tree and, if the options say so, of its mapped objects (GlobalWindow, AdjustBundle). The
// map is not changed.
IslandAdjustment AdjustIsland(const Map& map, IslandId island, const Sensor& sensor,
                              const ObjectOptions& options, const Cancellation* cancellation,
                              const ProgressCallback& on_progress = {});

}  // namespace hullslam
