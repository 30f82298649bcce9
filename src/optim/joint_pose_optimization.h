// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/frame/detection.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_options.h"
#include "optim/pose_optimization.h"

namespace hullslam {

// A mapped object found in the image.
struct PoseObject {
  Ellipsoid ellipsoid;                   // world frame
  const Detection* detection = nullptr;  // must outlive the call
  std::vector<SilhouetteLine> lines;     // the detection's, or these moved
  double misfit_px = 0.0;                // of the ellipsoid to these lines
};

struct JointPoseOptions {
  PoseOptimizationOptions points = {};
  ObjectPoseOptions objects = {};
};

struct JointPoseResult {
  PoseOptimizationResult points;     // the pose too
  std::vector<uint8_t> object_used;  // one an object; 0: dropped or without residual
  int used_objects = 0;
  int dropped_objects = 0;  // half of their lines or more were outliers
};

// As OptimizePose, with the outlines of objects beside the points: it minimises
//   sum over inlier points of rho_Huber(chi^2)
//   + the outline constraints of the used objects (MakeObjectConstraint), which are held fixed
//   + |rotation / prior_rotation|^2 + |translation / (prior_translation * d)|^2 from the start
// with d the mean distance of the objects.
// After each round points are chosen anew, and so are objects: an object is dropped when half of
// its residuals or more are outliers. With fewer than three inliers and fewer than min_objects used
// objects the start is given back. Without objects the result is that of OptimizePose to the last
// bit.
JointPoseResult OptimizeJointPose(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                  std::span<const PoseObservation> observations,
                                  std::span<const PoseObject> objects,
                                  const JointPoseOptions& options = {});

}  // namespace hullslam
