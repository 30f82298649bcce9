// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/util/cancellation.h"
#include "loop/loop_verification.h"
#include "util/id_set.h"

namespace hullslam {

// The poses of all keyframes of the loop's island after a pose graph has spread the error of the
// loop over them, and the loop's edge. The graph has the edges of the spanning tree, of strong
// covisibility, of earlier loops and of this one (the essential graph, Mur-Artal and Tardos 2014).
// The root of the candidate's spanning tree does not move. The correction has no poses if the graph
// could not be solved.
MapCorrection SpreadLoopError(const Map& map, const Loop& loop, bool fix_scale);

// The correction that joins the islands of the two ends of the loop. The younger island moves as a
// whole, by the similarity of the loop, and keeps its shape. The older island does not move.
MapCorrection MoveIsland(const Map& map, const Loop& loop);

// Searches the landmarks of the keyframes `observers` in the keyframes `searched`. Where one is
// found at a keypoint that shows another landmark, the merge of the two is added to `correction`.
// The landmark of `observers` is kept.
void AddLandmarkMerges(const Map& map, const Sensor& sensor,
                       const std::vector<KeyframeId>& searched,
                       const std::vector<KeyframeId>& observers, MapCorrection& correction);

// Adds the merges of the keyframes' objects that are duplicates of other objects.
void AddObjectMerges(const Map& map, const std::vector<KeyframeId>& observers,
                     const FusionOptions& fusion, MapCorrection& correction);

// Adds to `correction` the merges of landmarks and objects that were mapped at both ends of the
// loop. Landmarks around the candidate are searched in the keyframes around the query; objects
// around the query are compared with all others. `corrected` is the map with the correction.
void AddMerges(const Map& corrected, const Sensor& sensor, const Loop& loop,
               const FusionOptions& fusion, MapCorrection& correction);

// Bundle adjustment of the whole map, one island after the other. To be called after a loop was
// closed. The correction moves all keyframes and landmarks; objects follow their keyframes. Null if
// `cancellation` (may be null) was requested, or if the solver failed.
std::optional<MapCorrection> AdjustWholeMap(const Map& map, const Sensor& sensor,
                                            const ObjectOptions& objects,
                                            const Cancellation* cancellation);

}  // namespace hullslam
