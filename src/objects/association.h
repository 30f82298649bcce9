// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// Which objects detections are associated with.
enum class AssociationScope { kAll, kMapped };

// For each detection of a frame the object that it shows, invalid for none (Wu et al. 2023). The
// similarity of a detection and an object combines the IoU with the projected ellipse and with the
// last hull, shared landmarks, and rank-sum and t-tests of depth points. The assignment with the
// largest total similarity is chosen. The class is a vote: objects of another class are less
// similar, not excluded. Clouds that lie too far apart exclude a pair. `landmarks` has one entry
// per keypoint of the frame (or is empty).
std::vector<ObjectId> AssociateDetections(const Map& map, const Sensor& sensor, const Frame& frame,
                                          const Rigid3& cam_from_world,
                                          std::span<const LandmarkId> landmarks,
                                          AssociationScope scope,
                                          const AssociationOptions& options);

}  // namespace hullslam
