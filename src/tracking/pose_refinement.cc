// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/pose_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <utility>
#include <vector>

#include "frame/measure_point.h"
#include "optim/joint_pose_optimization.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Squared Mahalanobis distance of a prior that is dropped: the 99.9 % quantile for 6 degrees of
// freedom.
constexpr double kMostPriorError = 22.458;

}  // namespace

bool FusePrior(const Rigid3& expected, const Matrix6d& covariance, PoseEstimate& estimate) {
  const Matrix6d prior_information = covariance.inverse();
  const Eigen::Matrix<double, 6, 1> step = Difference(estimate.cam_from_world, expected);
  const Matrix6d both = covariance + estimate.information.inverse();
  if (!(step.dot(both.llt().solve(step)) <= kMostPriorError)) {
    return false;
  }
  estimate.information += prior_information;
  estimate.cam_from_world =
      Retract(estimate.cam_from_world, estimate.information.llt().solve(prior_information * step));
  return true;
}

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
  estimate.information = joint.information;
  std::vector<double> depths;
  for (size_t k = 0; k < keypoints.size(); ++k) {
    if (joint.points.is_inlier[k] == 0) {
      estimate.landmarks[keypoints[k]] = LandmarkId();
    } else {
      depths.push_back((estimate.cam_from_world * observations[k].point).z());
    }
  }
  estimate.median_depth = depths.empty() ? 0.0 : Median(std::move(depths));
  estimate.corner_sigma =
      estimate.median_depth == 0.0
          ? 0.0
          : CornerSigma(context.sensor.camera, joint.information, estimate.median_depth);
  return estimate;
}

}  // namespace hullslam
