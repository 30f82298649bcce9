// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "costs/make_object_cost.h"
#include "hullslam/geometry/dual_quadric.h"
#include "optim/pose_optimization.h"

namespace hullslam {

// A mapped object found in the image.
struct PoseObject {
  Ellipsoid ellipsoid;            // world frame
  ObjectMeasurement measurement;  // its spans must outlive the call
  // Standard deviation of a line, px: hypot(that of the outline, the object's misfit).
  double sigma_px = 0.5;
};

struct JointPoseOptions {
  PoseOptimizationOptions points = {};
  ObjectResidual residual = ObjectResidual::kTangent;
  ObjectPrimitive primitive = ObjectPrimitive::kSupport;
  // The lines of one detection weigh as so many at most: their errors are strongly correlated.
  double max_effective_lines = 8.0;
  double cauchy = 2.5;  // sigmas; where the loss of a line turns, and above which it is an outlier
  // Sigmas of a prior at the start, only where there are objects. Weak beside the pull of one
  // object or a few points, it holds what silhouettes leave free: a distance that all outlines
  // share, the turn around a single object.
  double prior_rotation = 0.1;     // radians
  double prior_translation = 0.1;  // m
  int min_objects = 2;             // that hold a pose without points
};

struct JointPoseResult {
  PoseOptimizationResult points;     // the pose too
  std::vector<uint8_t> object_used;  // one an object; 0: dropped or without residual
  int used_objects = 0;
  int dropped_objects = 0;  // half of their lines or more were outliers
};

// As OptimizePose, with the outlines of objects beside the points: it minimises
//   sum over inlier points of rho_Huber(chi^2)
//   + sum over used objects of min(1, max_effective_lines / n) sum over their n residuals r of
//     c^2 ln(1 + (r / sigma / c)^2)
//   + |turn / prior_rotation|^2 + |shift / prior_translation|^2 from the start,
// with sigma = ResidualOfPixelError(sigma_px) and the objects held fixed. After each round points
// are chosen anew, and so are objects: one whose residuals are outliers by half or more is dropped.
// With fewer than three inliers and fewer than min_objects used objects the start is given back.
// Without objects the result is that of OptimizePose to the last bit.
JointPoseResult OptimizeJointPose(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                  std::span<const PoseObservation> observations,
                                  std::span<const PoseObject> objects,
                                  const JointPoseOptions& options = {});

}  // namespace hullslam
