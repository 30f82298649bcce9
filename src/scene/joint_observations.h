// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/map/map.h"
#include "hullslam/util/id.h"

namespace hullslam {

// Counts of the keyframes that show two objects. The first object is A, the second B.
struct JointObservations {
  size_t observations = 0;  // keyframes that observe both
  size_t in_front = 0;      // of these, the ones in which A is before B: nearer, and across from it
  size_t mask_inside = 0;   // of these, the ones in which the hull of A's mask is inside B's
};

// How often B hides A from the keyframes that observe A or B.
struct HiddenCounts {
  size_t observations = 0;  // keyframes in whose image A should be, and that observe one of the two
  size_t hidden = 0;        // of these, the ones in which B is before at least a quarter of A
  double most = 0.0;        // the largest share of A's projected ellipse that B is before, 0 to 1
};

using ObjectPair = std::pair<ObjectId, ObjectId>;  // (A, B); both orders are there

struct ObservationStatistics {
  std::map<ObjectPair, JointObservations> joint;
  std::map<ObjectPair, HiddenCounts> hidden;

  const JointObservations& Joint(ObjectId a, ObjectId b) const;
};

// Collects them for the mapped objects of a map.
ObservationStatistics CollectObservationStatistics(const Map& map, const PinholeCamera& camera);

}  // namespace hullslam
