// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "objects/object_index.h"

namespace hullslam {

// The agreement of the detections of a frame with the mapped objects, as seen from a certain pose.
struct Arrangement {
  std::vector<ObjectId> objects;  // one per detection; invalid where it shows no mapped object
  int matched = 0;                // detections that show a mapped object
  double overlap = 0.0;           // sum of the IoU of their hulls with the projected ellipses
  int missed = 0;                 // mapped objects that the frame should show (LocationVisibility)

  // The sum of the overlaps, minus one half for each missed object.
  double Score() const { return overlap - 0.5 * missed; }
};

// Matches detections and mapped objects of the pose's island by class and by the IoU of hull and
// projected ellipse, those with the largest IoU first. `index` is that of the map.
Arrangement CompareArrangement(const Map& map, const ObjectIndex& index, const Sensor& sensor,
                               const Frame& frame, const Rigid3& cam_from_world, IslandId island,
                               const ObjectOptions& options);

}  // namespace hullslam
