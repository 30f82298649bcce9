// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// What a program that plans with the map wants to be told.
enum class MapEventKind {
  kLost,          // the camera was tracked in the frame before
  kRelocalised,   // it was lost, and is tracked again
  kIslandBegun,   // a part of the map that has no known pose relative to the others was begun
  kIslandJoined,  // such a part was joined to another one
  kLoopClosed,
  kRescaled,     // lengths have another unit than before, and nothing else has changed
  kAdjusted,     // all poses were computed again, as after a loop
  kObjectBorn,   // it has a shape from now on
  kObjectFused,  // it was found to be the same as another one
  kObjectMoved,  // its centre is elsewhere by more than its mean half axis, without a correction
  kObjectGone,   // it was removed, or its shape contradicts its views
};

// The name in files and messages, such as "loop_closed".
std::string_view ToString(MapEventKind kind);

struct MapEvent {
  MapEventKind kind = MapEventKind::kAdjusted;
  // Events of objects: the object, and the one that it was fused with.
  ObjectId object = {};
  ObjectId kept = {};
  // Loops, joins, scales and adjustments: the mean and the largest distance by which keyframes have
  // moved, m. Both are the distance by which the centre has moved if it is an object that has.
  double mean_moved = 0.0;
  double most_moved = 0.0;
  // The factor by which lengths in the map have grown: the median of all keyframes.
  double scale = 1.0;
};

// The events between two states of one map, of which `before` may be empty. Corrections come first,
// then objects by increasing id. The time is that of a walk through the objects and, only after a
// correction, through the keyframes.
std::vector<MapEvent> EventsBetween(const Map& before, const Map& after);

}  // namespace hullslam
