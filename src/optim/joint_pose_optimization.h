// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/detection.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_options.h"
#include "optim/pose_optimization.h"

namespace hullslam {

// A mapped object found in the image.
struct PoseObject {
  Ellipsoid ellipsoid;                   // world frame
  const Detection* detection = nullptr;  // must outlive the call
  std::vector<SilhouetteLine> lines;  // lines of the detection, possibly after misfit compensation
  double misfit_px = 0.0;             // the remaining misfit of these lines
  std::vector<SilhouetteLine> right_lines = {};  // the same of the right image
};

struct JointPoseOptions {
  PoseOptimizationOptions points = {};
  ObjectPoseOptions objects = {};
};

struct JointPoseResult {
  PoseOptimizationResult points;     // has the pose
  std::vector<uint8_t> object_used;  // one per object; 0 if dropped or without residual
  int used_objects = 0;
  int dropped_objects = 0;  // because half of their residuals or more were outliers
  // The inverse covariance of the pose by the six parameters of Retract, as the inliers and the
  // used objects determine it; without the prior.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

// Like OptimizePose, but mapped objects constrain the pose together with the points. It minimises
//   sum over inlier points of rho_Huber(chi^2)
//   + the silhouette constraints of the used objects (MakeObjectConstraint) with fixed quadrics
//   + |rotation / prior_rotation|^2 + |translation / (prior_translation * d)|^2 of the motion from
//     the start, where d is the mean distance of the objects.
// After each round the inlier points and the used objects are chosen again. An object is dropped if
// half of its residuals or more are outliers. With fewer than three inliers and fewer than
// min_objects used objects the result is the start. Without objects the result is that of
// OptimizePose to the last bit.
JointPoseResult OptimizeJointPose(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                  std::span<const PoseObservation> observations,
                                  std::span<const PoseObject> objects,
                                  const JointPoseOptions& options = {});

// How well a pose is determined, in px (raw px of a fisheye lens): the standard deviation with
// which it places a point at `depth` (z in the camera frame) in the direction in which it is
// largest, in that corner of the raw image in which it is largest. A corner beyond the largest
// angle of a fisheye lens counts as the last pixel on the way to it. `information` is the inverse
// covariance of the pose by the six parameters of Retract (JointPoseResult::information). Infinite
// if it cannot be inverted.
//
// A step (w, v) of the pose moves a point x of the camera frame by -[x]_x w + v. With J, the
// derivative of the pixel by the step, the covariance of the pixel is J information^-1 J^T. It does
// not depend on the unit of length. It is large if the landmarks of the pose are few, or if they
// are all in one small part of the image or along one line: they fix the pose there and let it
// turn elsewhere.
double CornerSigma(const PinholeCamera& camera, const Eigen::Matrix<double, 6, 6>& information,
                   double depth);

}  // namespace hullslam
