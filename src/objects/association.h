// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "objects/object_index.h"

namespace hullslam {

// The objects with which detections may be associated.
enum class AssociationScope { kAll, kMapped };

// A frame and the map whose objects it may show. The references must outlive this struct.
struct AssociationInput {
  const Map& map;
  const ObjectIndex& index;  // of the map; the map may have more objects
  const Sensor& sensor;
  const Frame& frame;
  Rigid3 cam_from_world;
  IslandId island;                             // of the pose; objects of other islands do not count
  std::span<const LandmarkId> landmarks = {};  // one per keypoint of the frame, or empty
  AssociationScope scope = AssociationScope::kAll;
};

// Returns the object that each detection of the frame shows. The id is invalid if the detection
// shows no known object. A pair is excluded if the clouds of depth points are too far apart, and
// the assignment with the largest total similarity is chosen. The default measure of similarity is
// CombinedSimilarity(): another class makes a pair less similar but does not exclude it. The other
// measures are in association_measure.h.
std::vector<ObjectId> AssociateDetections(const AssociationInput& input,
                                          const AssociationOptions& options);

}  // namespace hullslam
