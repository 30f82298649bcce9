// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/frame.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"

namespace hullslam {

// A pose of a frame at which some of its detections show mapped objects.
struct PoseHypothesis {
  Rigid3 cam_from_world;
  double agreement = 0.0;  // sum over the detections, each up to 1
  double distance = 0.0;   // mean distance of these objects from the camera, in units of the map
};

// Poses of a frame, computed only from its detections and the mapped objects of an island, the best
// ones first. They are rough, because the centres of the objects are known from depth points and
// hulls only to a few centimetres.
//
// A detection may show any mapped object of its class and size. Three detections with depth give
// three centres in the camera frame, and so a rigid motion if the distances between them are those
// of the mapped objects; without depth they give the poses of P3P. With two detections only (or if
// no three of them fit), the angle about the line through the two centres is searched: the
// projected ellipses must have the positions and sizes of the hulls. The numbers of triples and
// pairs that are tried, and of poses that are returned, are bounded; no choice is random.
std::vector<PoseHypothesis> ProposePoses(const Map& map, const PinholeCamera& camera,
                                         const Frame& frame, IslandId island);

// Whether two poses of a frame are so near to each other that they stand for the same place.
// `depth` is the mean depth of the scene in the frame, in units of the map.
bool AreSamePlace(const Rigid3& a, const Rigid3& b, double depth);

}  // namespace hullslam
