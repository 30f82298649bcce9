// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_options.h"
#include "loop/loop_verification.h"
#include "util/id_set.h"

namespace hullslam {

// The keyframe and all that are covisible with it, by increasing id.
std::vector<KeyframeId> KeyframesAround(const Map& map, KeyframeId keyframe);

// The poses of all keyframes of the loop's island after a pose graph has spread the error of the
// loop over them, and the loop's edge. The graph has the edges of the spanning tree, of strong
// covisibility, of earlier loops and of this one (the essential graph, Mur-Artal and Tardos 2014).
// Without `fix_scale`, scales change most where landmarks tell least about them (ScaleInformation).
// The root of the candidate's spanning tree stays where it is. The correction has no poses if the
// graph could not be solved.
MapCorrection SpreadLoopError(const Map& map, const Loop& loop, bool fix_scale);

// The correction that makes one island of those of the loop's ends: the younger island moves as a
// whole, by the similarity of the loop. Nothing in it changes its shape, and the older one stays.
MapCorrection MoveIsland(const Map& map, const Loop& loop);

// Adds to `correction` the landmarks that the keyframes `searched` show although they show a
// landmark of `observers` there. Those of `observers` are kept.
void AddLandmarkMerges(const Map& map, const Sensor& sensor,
                       const std::vector<KeyframeId>& searched,
                       const std::vector<KeyframeId>& observers, MapCorrection& correction);

// Adds the objects of the keyframes that are duplicates of others.
void AddObjectMerges(const Map& map, const std::vector<KeyframeId>& observers,
                     const FusionOptions& fusion, MapCorrection& correction);

// Adds to `correction` what is one thing although it was mapped at both ends of the loop. Landmarks
// around the candidate are searched in the keyframes around the query; objects around the query are
// compared with all others. `corrected` is the map with the correction.
void AddMerges(const Map& corrected, const Sensor& sensor, const Loop& loop,
               const FusionOptions& fusion, MapCorrection& correction);

}  // namespace hullslam
