// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "hullslam/util/id.h"
#include "optim/joint_pose_optimization.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The pose of a frame, with the landmarks that were found in the frame.
struct PoseEstimate {
  // An object that constrains a pose counts as this many landmarks.
  static constexpr int kLandmarksPerObject = 5;

  Rigid3 cam_from_world;
  std::vector<LandmarkId> landmarks;  // one per keypoint; invalid where it shows no landmark
  int inliers = 0;                    // landmarks that agree with the pose
  int used_objects = 0;               // objects that constrain the pose
  double median_depth = 0.0;          // of the landmarks; 0 without landmarks
  // How well landmarks and objects determine the pose: CornerSigma at the median depth of the
  // landmarks, px. 0 without landmarks.
  double corner_sigma = 0.0;
  // JointPoseResult::information; 0 without landmarks.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  // The same without a motion prior. A sum of squares over quarters of the image, and its mean if
  // the errors of landmarks are independent. Of a prior: L and Q of DriftModel, axes of this
  // camera.
  Eigen::Matrix<double, 6, 6> seen_information = Eigen::Matrix<double, 6, 6>::Zero();
  double squares = 0.0;
  double expected_squares = 0.0;
  Eigen::Matrix<double, 6, 6> last_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> motion_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  // A keyframe that shows the same place as the frame; invalid if landmarks determine the place.
  KeyframeId keyframe_of_place;

  // The number of landmarks that would constrain the pose as much as the landmarks and objects do.
  int EffectiveInliers() const { return inliers + kLandmarksPerObject * used_objects; }
};

// The estimate with the pose that its landmarks and the objects explain best (OptimizeJointPose).
// Landmarks that do not agree with this pose are left out of it.
PoseEstimate RefinePose(const Frame& frame, const Map& map, const TrackingContext& context,
                        std::span<const PoseObject> objects, PoseEstimate estimate);

// Adds a pose that is expected from a motion prior, with its covariance by the parameters of
// Retract, to an estimate that was made without it: the sum of the squared errors of both is least,
// as if the prior had been a term of the normal equations. Returns false, and does nothing, if the
// two differ by more than their covariances allow (99.9 %).
bool FusePrior(const Rigid3& expected, const Eigen::Matrix<double, 6, 6>& covariance,
               PoseEstimate& estimate);

}  // namespace hullslam
