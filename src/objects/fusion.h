// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// The two objects, first the one to keep if they are copies of one thing: a locked one, the one of
// an earlier session, of which later changes are reported, or the one with more observations.
std::pair<ObjectId, ObjectId> KeptFirst(const Map& map, ObjectId a, ObjectId b);

// Pairs of objects of one island that are copies of one thing, in the order of KeptFirst. Two
// objects, not both locked, form a pair if few or no keyframes observe both and their quadrics
// overlap enough. For objects that no keyframe observes together, it is also enough that each
// quadric contains the centre of the other and the t-test finds no difference between their
// centroids. Each object is in at most one pair.
std::vector<std::pair<ObjectId, ObjectId>> FindDuplicates(const Map& map,
                                                          const FusionOptions& options = {});
// The same, but only pairs with at least one of the objects `changed` (by increasing id).
std::vector<std::pair<ObjectId, ObjectId>> FindDuplicates(const Map& map,
                                                          std::span<const ObjectId> changed,
                                                          const FusionOptions& options = {});

// The mapped object of which `candidate`, which has a shape, is a copy; nothing if there is none.
// Few or no keyframes observe both, and most masks of the candidate cover the other's ellipsoid, at
// its depth. Classes are not compared, since detectors confuse them, and neither are the shapes,
// since that of a candidate is often wrong. Without depth there is none.
std::optional<ObjectId> FindDoubled(const Map& map, const Sensor& sensor, ObjectId candidate,
                                    const FusionOptions& options = {});

// The mapped object that `candidate`, which has a shape, is probably a part of; nothing if there is
// none. It has the same class, the distance of the centres is at most the sum of the largest half
// axes, and no keyframe observes both, although its centre is in the image of most of the
// candidate's keyframes. (Example: a book that lies under another book shows one end in some
// keyframes and the other end in others.)
std::optional<ObjectId> FindWhole(const Map& map, const Sensor& sensor, ObjectId candidate);

// Intersection over union of the volumes of two ellipsoids, measured on a grid of 16^3 points in
// the smaller one.
double VolumeOverlap(const Ellipsoid& a, const Ellipsoid& b);

}  // namespace hullslam
