// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "eval/object_groundtruth.h"
#include "hullslam/geometry/sim3.h"
#include "hullslam/objects/object_changes.h"

namespace hullslam {

// The numbers of changes of one kind: true changes, reported changes, and reported changes that are
// right.
struct ChangeCounts {
  size_t in_truth = 0;
  size_t reported = 0;
  size_t right = 0;
};

struct ChangeComparison {
  ChangeCounts moved;
  ChangeCounts gone;
  ChangeCounts added;  // ObjectChange::kNew
  // Locations that an object left, and locations that an object newly takes. A moved object counts
  // in both, so it does not matter which of two cups was moved.
  ChangeCounts left;
  ChangeCounts taken;
};

// Compares the reported changes with a rearranged scene. A reported location agrees with a true
// object, of any class, if the distance of the two centres is at most half of the Size() of the
// true object. Each true object is counted once. Moving true objects are left out, and so are those
// of `scene.objects` whose entry in `sightings` is less than `min_sightings`; `sightings` may be
// empty. The scene is in metres; `truth_from_map` has the scale 1 if the map is in metres too.
ChangeComparison CompareChanges(const TrueScene& scene, std::span<const ChangedObject> changes,
                                const Sim3& truth_from_map, std::span<const size_t> sightings,
                                size_t min_sightings);

}  // namespace hullslam
