// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Pairs of objects that are one, the one to keep (with more observations) first: their quadrics
// share most of the smaller one's volume, or the t-test of their centroids holds and each centre
// lies in the other; and they were never, or hardly ever, seen together. An object is in one pair
// at most.
std::vector<std::pair<ObjectId, ObjectId>> FindDuplicates(const Map& map);

// The mapped object that `candidate`, which has a shape, is most likely a further part of: of the
// same class, no farther away than the largest half axes of both together, and never seen together
// with it although it should have been seen in most of the candidate's keyframes. (Of a book under
// another one now this end is seen, now that.)
std::optional<ObjectId> FindWhole(const Map& map, const Sensor& sensor, ObjectId candidate);

// Intersection over union of two ellipsoids' volumes, on a lattice of 16^3 points of each.
double VolumeOverlap(const Ellipsoid& a, const Ellipsoid& b);

}  // namespace hullslam
