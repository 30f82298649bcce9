// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "hullslam/frame/sensor.h"
#include "hullslam/loop/loop_options.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"
#include "loop/loop_verification.h"

namespace hullslam {

// Whether a second keyframe near the query, from which the similarity was not computed, shows
// enough of the landmarks around the candidate. This check replaces the drift budget, which does
// not exist between islands. `corrected` is the map in which the islands are joined.
bool IsConfirmedByNeighbour(const Map& corrected, const Sensor& sensor, const Loop& loop,
                            size_t min_landmarks);

// Looks for the place of a keyframe in other islands by matches without words
// (MatchLandmarksOf), so the islands may show the same place in images that are far apart, and an
// island may be a single keyframe. Returns the correction that joins the two islands; null if there
// is no such place. `seed` is the run's.
std::optional<MapCorrection> FindJoin(Map& map, KeyframeId query, const Sensor& sensor,
                                      const LoopOptions& options, const ObjectOptions& objects,
                                      uint64_t seed);

}  // namespace hullslam
