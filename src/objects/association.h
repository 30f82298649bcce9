// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/frame/detection.h"
#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "objects/object_index.h"

namespace hullslam {

// A detection with all its data that is compared.
struct SeenObject {
  const Detection* detection = nullptr;
  std::vector<LandmarkId> landmarks;                   // sorted
  std::vector<Eigen::Vector3d> cloud;                  // depth points, world
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // of the cloud
  double noise = 0.0;                                  // of the centroid, in units of the map
  double size = 0.0;                                   // SizeOf() the cloud
};

// The expected appearance of an object in a frame.
struct PredictedObject {
  ObjectId id;
  const ObjectLandmark* object = nullptr;
  std::optional<Ellipse> projected;                   // absent without a shape
  std::vector<Eigen::Vector2d> ellipse;               // projected, clipped to the image; or empty
  std::vector<std::vector<Eigen::Vector2d>> carried;  // CarryHull()
  std::vector<LandmarkId> landmarks;                  // in its latest observations, sorted
  std::vector<Eigen::Vector3d> cloud;                 // depth points of its last observation, world
  std::vector<Eigen::Vector3d> centroids;  // one per latest observation with depth points, world
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // of the cloud
  double size = 0.0;                                   // SizeOf() the cloud
};

// Twice the root mean square distance of the points from their mean. It is about half the diagonal
// of their box.
double SizeOf(std::span<const Eigen::Vector3d> points);

// Whether the clouds of depth points are so far apart that they cannot belong to the same object.
bool AreApart(const SeenObject& seen, const PredictedObject& predicted,
              const AssociationOptions& options);

size_t CountShared(const SeenObject& seen, const PredictedObject& predicted);

// The measure `combined`, after Wu et al. 2023: the sum of the larger of the two IoUs (with the
// projected ellipse and with the carried hulls), of the share of common landmarks, of the tests of
// the depth points, and of the share of votes for the detection's class, each times its weight. 0
// if they do not match, otherwise up to the sum of the weights (1.2 by default).
double CombinedSimilarity(const SeenObject& seen, const PredictedObject& predicted,
                          const AssociationOptions& options);

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
