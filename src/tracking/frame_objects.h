// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "optim/joint_pose_optimization.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracking_context.h"
#include "util/id_set.h"

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

// A detection that shows a mapped object. The object's landmarks are searched at the keypoints
// inside it.
struct ObjectGuide {
  std::vector<LandmarkId> landmarks;  // on the object and not known yet, by increasing id
  std::vector<uint8_t> is_outside;    // one per keypoint: 0 inside the detection's hull or near it
};

// The landmarks on an object with a shape: those that its masks show and that lie inside its
// ellipsoid or near it (NearSurface). Landmarks of the background in the masks lie farther away. By
// increasing id, without the known ones.
std::vector<LandmarkId> LandmarksOn(const Map& map, const ObjectLandmark& object,
                                    const IdSet<LandmarkId>& known,
                                    const ObjectOptions& options = {});

// A guide for each detection of the frame that shows an object with landmarks that are not known.
// `objects` has one entry per detection, invalid where it shows no mapped object
// (FindMappedObjects), or is empty. As in VOOM (Wang et al. 2024), an object gives access to its
// landmarks even if the frame shares few landmarks with the object's keyframes.
std::vector<ObjectGuide> GuideByObjects(const Map& map, const Frame& frame,
                                        std::span<const ObjectId> objects,
                                        const IdSet<LandmarkId>& known,
                                        const ObjectOptions& options = {});

}  // namespace hullslam
