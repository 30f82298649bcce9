// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "objects/object_index.h"

namespace hullslam {

// The objects with which detections may be associated.
enum class AssociationScope { kAll, kMapped };

// Returns the object that each detection of a frame shows. The id is invalid if the detection shows
// no known object. The default measure (Wu et al. 2023; others are in association_measure.h): the
// similarity of a detection and an object combines the IoU
// with the projected ellipse and with the last hull, shared landmarks, rank-sum and t-tests of
// depth points, and the class. Another class makes a pair less similar but does not exclude it. A
// pair is excluded if the clouds of depth points are too far apart. The assignment with the largest
// total similarity is chosen. `island` is the island of the map that the pose belongs to; objects
// of other islands are not considered. `landmarks` has one entry per keypoint of the frame, or it
// is empty. `index` is that of the map; the map may have more objects.
std::vector<ObjectId> AssociateDetections(const Map& map, const ObjectIndex& index,
                                          const Sensor& sensor, const Frame& frame,
                                          const Rigid3& cam_from_world, IslandId island,
                                          std::span<const LandmarkId> landmarks,
                                          AssociationScope scope,
                                          const AssociationOptions& options);

}  // namespace hullslam
