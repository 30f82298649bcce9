// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "optim/joint_pose_optimization.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The mapped objects that a frame shows, ready for OptimizeJointPose.
struct PoseObjects {
  std::vector<ObjectId> ids;
  std::vector<PoseObject> objects;  // one per id
};

// The mapped object that each detection of a frame shows. One entry per detection; invalid where it
// shows no mapped object. The objects are those of the island that the pose belongs to. All entries
// are invalid if objects are not used in tracking. See AssociateDetections.
std::vector<ObjectId> FindMappedObjects(const Frame& frame, const Map& map,
                                        const TrackingContext& context,
                                        const PoseEstimate& estimate, IslandId island);

// The detections of a frame that show mapped objects (`ids`: one per detection). With misfit
// compensation each line is moved by the excess that the keyframes have measured for its normal;
// lines with normals that no keyframe has measured are left out. If fewer than half of a
// detection's lines would remain, its lines are used without compensation.
PoseObjects MakePoseObjects(const Map& map, const Sensor& sensor, const Frame& frame,
                            const Rigid3& cam_from_world, std::span<const ObjectId> ids,
                            const ObjectOptions& options);

}  // namespace hullslam
