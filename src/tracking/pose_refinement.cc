// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/pose_refinement.h"

#include <vector>

namespace hullslam {
namespace {

// Keypoint `keypoint` of a frame as an observation of a point at `position` (m, world frame).
PoseObservation ObservationOf(const FrameFeatures& features, size_t keypoint,
                              const ScaleLevels& levels, const Eigen::Vector3d& position) {
  const Keypoint& seen = features.keypoints[keypoint];
  PoseObservation observation;
  observation.point = position;
  observation.measured << seen.undistorted.cast<double>(),
      static_cast<double>(seen.undistorted.x() - features.right_u[keypoint]);
  observation.has_depth = features.right_u[keypoint] >= 0.0f;
  observation.inverse_sigma2 =
      static_cast<double>(levels.inverse_sigma2[static_cast<size_t>(seen.level)]);
  return observation;
}

}  // namespace

PoseEstimate RefinePose(const Frame& frame, const Map& map, const TrackingContext& context,
                        std::span<const PoseObject> objects, PoseEstimate estimate) {
  std::vector<PoseObservation> observations;
  std::vector<size_t> keypoints;
  for (size_t i = 0; i < estimate.landmarks.size(); ++i) {
    if (estimate.landmarks[i].IsValid()) {
      const Eigen::Vector3d& position = map.landmarks().At(estimate.landmarks[i]).position;
      observations.push_back(ObservationOf(frame.features, i, context.sensor.levels, position));
      keypoints.push_back(i);
    }
  }
  const JointPoseResult joint =
      OptimizeJointPose(context.sensor.camera, estimate.cam_from_world, observations, objects,
                        {.objects = context.objects.pose});
  estimate.cam_from_world = joint.points.cam_from_world;
  estimate.inliers = joint.points.inlier_count;
  estimate.used_objects = joint.used_objects;
  for (size_t k = 0; k < keypoints.size(); ++k) {
    if (joint.points.is_inlier[k] == 0) {
      estimate.landmarks[keypoints[k]] = LandmarkId();
    }
  }
  return estimate;
}

}  // namespace hullslam
