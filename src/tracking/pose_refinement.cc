// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/pose_refinement.h"

#include <utility>
#include <vector>

#include "frame/measure_point.h"
#include "optim/joint_pose_optimization.h"
#include "util/statistics.h"

namespace hullslam {

PoseEstimate RefinePose(const Frame& frame, const Map& map, const TrackingContext& context,
                        std::span<const PoseObject> objects, PoseEstimate estimate) {
  std::vector<PoseObservation> observations;
  std::vector<size_t> keypoints;
  for (size_t i = 0; i < estimate.landmarks.size(); ++i) {
    if (estimate.landmarks[i].IsValid()) {
      observations.push_back(
          {.point = map.landmarks().At(estimate.landmarks[i]).position,
           .measurement = MeasurePoint(context.sensor, frame.features, static_cast<uint32_t>(i),
                                       context.sensor.depth_error)});
      keypoints.push_back(i);
    }
  }
  const JointPoseResult joint =
      OptimizeJointPose(context.sensor.camera, estimate.cam_from_world, observations, objects,
                        {.objects = context.objects.pose});
  estimate.cam_from_world = joint.points.cam_from_world;
  estimate.inliers = joint.points.inlier_count;
  estimate.used_objects = joint.used_objects;
  std::vector<double> depths;
  for (size_t k = 0; k < keypoints.size(); ++k) {
    if (joint.points.is_inlier[k] == 0) {
      estimate.landmarks[keypoints[k]] = LandmarkId();
    } else {
      depths.push_back((estimate.cam_from_world * observations[k].point).z());
    }
  }
  estimate.corner_sigma = depths.empty() ? 0.0
                                         : CornerSigma(context.sensor.camera, joint.information,
                                                       Median(std::move(depths)));
  return estimate;
}

}  // namespace hullslam
