// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>

#include "hullslam/map/messages.h"
#include "hullslam/map/tracking_failure.h"

namespace hullslam {

inline constexpr size_t kMinInitialPoints = 50;

// The last step of an initial map, after its adjustment. Removes the points that are not in front
// of the first view, and makes the median depth of the others in it 1. Returns why the map cannot
// be used, if it cannot: too few points are left, or the rays from the first and the last view to
// more of them than `share` are nearly parallel. The first view must be at the origin.
std::optional<InitialisationFailure> FinishInitialMap(InitialMap& map, double share = 0.5);

}  // namespace hullslam
