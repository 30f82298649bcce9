// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// Pairs of objects that are the same thing; the first of a pair is the one to keep, which has more
// observations. Their quadrics overlap enough, or each contains the other's centre and the t-test
// does not tell their centroids apart; and they were never, or hardly ever, seen together. An
// object is in one pair at most.
std::vector<std::pair<ObjectId, ObjectId>> FindDuplicates(const Map& map,
                                                          const FusionOptions& options = {});

// The mapped object that `candidate`, which has a shape, is most likely a further part of: of the
// same class, no farther away than the largest half axes of both together, and never seen together
// with it although it should have been seen in most of the candidate's keyframes. (A book under
// another one shows one end in some keyframes and the other end in others.)
std::optional<ObjectId> FindWhole(const Map& map, const Sensor& sensor, ObjectId candidate);

// Intersection over union of two ellipsoids' volumes, on a lattice of 16^3 points of each.
double VolumeOverlap(const Ellipsoid& a, const Ellipsoid& b);

}  // namespace hullslam
