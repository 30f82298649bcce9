// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// The mapped objects that agree or disagree with a loop.
struct ObjectVotes {
  int agree = 0;     // objects of the query at the location of an object of the candidate
  int disagree = 0;  // objects at whose location the other end has another class or nothing

  // Whether the objects disagree with the loop. A single object does not count: it may be an error
  // of the detector, or it was moved or taken away.
  bool IsAgainst() const { return disagree >= 2 && disagree > agree; }
  // Whether both ends of the loop have the same arrangement of objects.
  bool IsFor() const { return agree >= 2 && agree > disagree; }
};

// Compares the objects that the keyframes around the query observe with those around the candidate.
// `corrected` is the map with the correction of the loop, in which the two copies of an object have
// the same location.
ObjectVotes CountObjectVotes(const Map& corrected, const Sensor& sensor, KeyframeId query,
                             KeyframeId candidate, const ObjectOptions& options);

}  // namespace hullslam
