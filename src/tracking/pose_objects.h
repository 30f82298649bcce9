// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <span>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "optim/joint_pose_optimization.h"
#include "tracking/pose_estimate.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The mapped objects that a frame shows, ready for OptimizeJointPose.
struct PoseObjects {
  std::vector<ObjectId> ids;
  std::vector<PoseObject> objects;                // one an id
  std::deque<std::vector<SilhouetteLine>> lines;  // that the measurements refer to
};

// The mapped object that each detection of a frame shows, invalid for none; one entry per
// detection. All are invalid where objects take no part in tracking. See AssociateDetections.
std::vector<ObjectId> FindMappedObjects(const Frame& frame, const Map& map,
                                        const TrackingContext& context,
                                        const PoseEstimate& estimate);

// Detections of a frame with the objects they show (`ids`: one a detection). With misfit
// compensation the lines are moved by what keyframes tell of the object there; lines of which they
// tell nothing are left out, unless less than half of a detection's would remain: then it is taken
// as it is.
PoseObjects MakePoseObjects(const Map& map, const Sensor& sensor, const Frame& frame,
                            const Rigid3& cam_from_world, std::span<const ObjectId> ids,
                            const ObjectOptions& options);

}  // namespace hullslam
