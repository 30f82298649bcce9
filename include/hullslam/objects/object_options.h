// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/detection_options.h"
#include "hullslam/objects/object_constraint_options.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// What makes a detection one of an object; see AssociateDetections.
struct AssociationOptions {
  double min_projection_iou = 0.25;  // of the hull with the projected ellipse
  double min_carried_iou = 0.5;      // of the hull with the last one, carried over at its depth
  int min_shared_landmarks = 3;
  double min_shared_ratio = 0.5;  // of landmarks in the detection
  double class_weight = 0.2;      // of the share of votes for the class in the similarity
  double max_rank_sum = 1.282;    // standard score
  int min_cloud = 20;             // points for the rank-sum test
  double alpha = 0.001;           // of the t-test of centroids
  double centroid_noise = 0.02;   // m
  double max_offset = 1.0;        // between centroids, in sizes of the object
};

// When a candidate's shape is sought, and where the search starts.
struct StartOptions {
  int min_views = 3;                         // keyframes
  double min_parallax = 3.0;                 // degrees between viewing rays, with depth
  double min_parallax_without_depth = 15.0;  // degrees
  double inflation = 1.2;                    // of the oriented bounding box of the points
};

// What a mapped object must satisfy; see FindObjection.
struct ValidityOptions {
  double min_overlap = 0.6;      // mean IoU of projected ellipse and hull
  double min_points_near = 0.4;  // share of depth points in the quadric or near its surface
};

// Refinement: one quadric, poses fixed. The sigma of an outline is the object's misfit, bounded
// from both sides.
struct ObjectRefinementOptions {
  // Its loss_scale is not used: see loss_px.
  ObjectConstraintOptions constraint = {
      .sigma_px = 0.0,
      .max_effective_lines = 4.0,
      .loss = RobustLoss::kHuber,
      .depth = {.max_points = 20, .loss_scale = 1.0},
      // About the start. Its centre and rotation are those of the side that was seen first, so
      // their sigmas are large.
      .prior = {.log_axes = 0.5, .center = 2.0, .rotation = 1.0},
      .prior_without_depth = {.log_axes = 0.15, .center = 2.0, .rotation = 1.0}};
  double min_misfit_px = 1.0;
  double max_misfit_px = 5.0;  // also that of a start, whose misfit is not known yet
  double loss_px = 8.0;        // the loss scale, px, of an outline whose sigma is max_misfit_px
};

// Joint pose: the camera moves, objects are fixed. Depth points and the prior of the object are not
// used.
struct ObjectPoseOptions {
  // An object is dropped when half of its residuals are beyond the loss scale.
  ObjectConstraintOptions constraint = {};
  // Sigmas of a prior on the pose, about the start, only where there are objects. The prior is weak
  // compared with one object or a few points. It constrains what outlines leave free: a distance
  // that all outlines share, the rotation around a single object.
  double prior_rotation = 0.1;     // radians
  double prior_translation = 0.1;  // m
  int min_objects = 2;             // that constrain a pose without points
};

// Bundle adjustment: quadrics move together with poses and landmarks. Every detection of an object
// counts, also those in keyframes outside of the window. The poses of those keyframes are fixed.
// Without them, what a few new views leave free of a quadric would be lost.
struct ObjectBundleOptions {
  ObjectConstraintOptions constraint = {
      // The misfit of an ellipsoid is the same in all similar views.
      .misfit_factor = 2.0,       .loss = RobustLoss::kTukey, .loss_scale = 6.0,
      .min_loss_px = 15.0,  // a loss that ignores smaller errors spoils the shape
      .depth = {.max_points = 6},
      // About the quadric as it is when the adjustment begins, so that the prior damps what the
      // views leave free. A prior about the start, the side that was seen first, would pull the
      // cameras along.
  };
  int max_outer_views = 5;  // detections outside of the window, evenly chosen
};

// Objects as landmarks: what they take part in, and how their shape is found.
struct ObjectOptions {
  bool enabled = true;
  bool joint_pose = true;         // mapped objects constrain the pose of each frame
  bool bundle_adjustment = true;  // quadrics are moved together with poses and points
  bool misfit_compensation = true;
  bool guided_matching = true;  // landmarks on objects that the local map lacks are searched
  DetectionOptions detection;
  AssociationOptions association;
  StartOptions start;
  ValidityOptions validity;
  ObjectRefinementOptions refinement;
  ObjectPoseOptions pose;
  ObjectBundleOptions bundle;

  void Bind(OptionTable& options);
  // Throws InputError where a use has a residual that cannot be computed from the primitive.
  void Validate() const;
};

}  // namespace hullslam
