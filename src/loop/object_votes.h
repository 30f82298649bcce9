// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// What the mapped objects say about a loop.
struct ObjectVotes {
  int agree = 0;     // objects of the query that are at the place of one of the candidate
  int disagree = 0;  // those where another class is, or where the other keyframe sees nothing

  // Whether the objects speak against the loop. A single one may be a fault of the detector, or it
  // was moved or taken away.
  bool IsAgainst() const { return disagree >= 2 && disagree > agree; }
  // Whether there is the same arrangement of objects at both ends.
  bool IsFor() const { return agree >= 2 && agree > disagree; }
};

// Compares the objects that the keyframes around the query observe with those around the candidate.
// `corrected` is the map with the correction of the loop, in which the same things are at the same
// place.
ObjectVotes CountObjectVotes(const Map& corrected, const Sensor& sensor, KeyframeId query,
                             KeyframeId candidate, const ObjectOptions& options);

}  // namespace hullslam
