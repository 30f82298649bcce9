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

// The frame of a keyframe that the map has or has culled; invalid if it has forgotten it.
FrameId FrameOf(const Map& map, KeyframeId id) {
  if (const Keyframe* const keyframe = map.keyframes().Find(id)) {
    return keyframe->frame->id;
  }
  const CulledKeyframe* const culled = map.FindCulled(id);
  return culled != nullptr ? culled->frame : FrameId();
}

}  // namespace

Matrix6d DriftModel::Covariance(const Map& map, const PoseEstimate& estimate) const {
  IdMap<KeyframeId, int> created;
  int all = 0;
  for (const LandmarkId id : estimate.landmarks) {
    if (id.IsValid()) {
      ++created[map.landmarks().At(id).created_by];
      ++all;
    }
  }
  Matrix6d drift = Matrix6d::Zero();
  for (const auto& [keyframe, count] : created.entries()) {
    if (const Drift* const of_keyframe = drifts_.Find(FrameOf(map, keyframe))) {
      drift += static_cast<double>(count) / all * of_keyframe->covariance;
    }
  }
  return estimate.information.inverse() + InAxesOf(estimate.cam_from_world, drift);
}

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

void DriftModel::Add(FrameId keyframe, const Rigid3& cam_from_world, const Matrix6d& covariance) {
  drifts_[keyframe].covariance = InAxesOf(Inverse(cam_from_world), covariance);
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
