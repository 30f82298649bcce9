// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "optim/joint_pose_optimization.h"

namespace hullslam {

// The mapped objects that a frame shows, ready for OptimizeJointPose.
struct PoseObjects {
  std::vector<ObjectId> ids;
  std::vector<PoseObject> objects;  // one per id
};

// For each detection of a frame the mapped object that it shows, invalid for none; see
// AssociateDetections. `landmarks` has one entry a keypoint (or is empty).
std::vector<ObjectId> FindMappedObjects(const Map& map, const Sensor& sensor, const Frame& frame,
                                        const Rigid3& cam_from_world,
                                        std::span<const LandmarkId> landmarks,
                                        const AssociationOptions& options);

// Detections of a frame with the objects they show (`ids`: one per detection). With misfit
// compensation the lines are moved by the misfit that the object's keyframes predict, and lines
// without a prediction are left out. A detection that would keep less than half of its lines is
// taken as it is.
PoseObjects MakePoseObjects(const Map& map, const Sensor& sensor, const Frame& frame,
                            const Rigid3& cam_from_world, std::span<const ObjectId> ids,
                            const ObjectOptions& options);

}  // namespace hullslam
