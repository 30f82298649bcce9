// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/detection_options.h"
#include "hullslam/objects/object_constraint_options.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// Lengths are shares of the object's distance from the cameras, so that they mean the same in a map
// whose scale is not known.

// What makes a detection one of an object; see AssociateDetections.
struct AssociationOptions {
  double min_projection_iou = 0.25;  // of the hull with the projected ellipse
  double min_carried_iou = 0.5;      // of the hull with the last one, carried over at its depth
  double min_depth_iou = 0.1;        // the larger of both, where depth points agree
  int min_shared_landmarks = 3;
  double min_shared_ratio = 0.5;  // of landmarks in the detection
  int recent_views = 5;           // whose landmarks and centroids stand for an object
  int cloud_points = 40;          // depth points of a cloud that are compared, at most
  int min_cloud = 20;             // points for the rank-sum test
  double max_rank_sum = 1.282;    // standard score
  double alpha = 0.001;           // of the t-test of centroids
  double centroid_noise = 0.02;   // of the distance
  double max_offset = 1.0;        // between centroids, in sizes of the object
  // Shares of the similarity of a match: the larger IoU, shared landmarks, one cloud, one centroid,
  // votes for the class.
  double iou_weight = 0.6;
  double landmark_weight = 0.2;
  double cloud_weight = 0.1;
  double centroid_weight = 0.1;
  double class_weight = 0.2;
  double min_similarity = 0.2;  // a detection that is less similar shows no known object
};

// When a candidate's shape is sought, and where the search starts.
struct StartOptions {
  int min_views = 3;                         // keyframes
  double min_parallax = 3.0;                 // degrees between viewing rays, with depth
  double min_parallax_without_depth = 15.0;  // degrees
  int max_points = 2000;                     // depth points that are taken, about
  double trimmed = 0.03;        // share of the points left out at each end of each axis
  double inflation = 1.2;       // of the oriented bounding box of the points
  double min_half_axis = 0.01;  // of the distance; flat things have some thickness
};

// What a mapped object must satisfy; see FindObjection.
struct ValidityOptions {
  double min_half_axis = 0.005;     // of the distance
  double max_half_axis = 3.0;       // of the distance
  double min_overlap = 0.6;         // mean IoU of projected ellipse and hull
  double min_points_near = 0.4;     // share of depth points in the quadric or near its surface
  double near_surface = 0.03;       // near: at most this far outside, of the distance,
  double near_surface_share = 0.2;  // or at most so many mean half axes
  double max_stretch = 2.5;         // half axis over the reach of the points along it
};

// When two objects are one; see FindDuplicates.
struct FusionOptions {
  double min_overlap = 0.25;          // IoU of the volumes, of objects never seen together
  double min_overlap_together = 0.5;  // of objects seen together in few keyframes
  double max_shared_keyframes = 0.2;  // of those of the object that fewer keyframes observe
  double alpha = 0.05;                // of the t-test of centroids
  double centroid_noise = 0.02;       // of the distance
};

// When an object is removed.
struct CullingOptions {
  int candidate_keyframes = 20;   // a candidate that so many keyframes do not see is removed
  int min_visible = 10;           // keyframes that should show a mapped object, before
  double min_found_ratio = 0.25;  // the share of them that do is judged
};

// How the misfit of an object is measured; see objects/misfit.h.
struct MisfitOptions {
  int views = 40;      // the latest; samples are taken of them
  double width = 4.0;  // degrees, of the Gaussian weights of the samples
};

// Which landmarks lie on an object, for guided matching.
struct GuideOptions {
  int views = 20;  // keyframes whose masks are looked at, at most
};

// Refinement: one quadric, poses fixed. The sigma of an outline is the object's misfit, bounded
// from both sides.
struct ObjectRefinementOptions {
  // Its loss_scale is not used: see loss_px.
  ObjectConstraintOptions constraint = {
      .sigma_px = 0.0,
      .max_effective_lines = 4.0,
      .loss = RobustLoss::kHuber,
      .depth = {.max_points = 20, .choice = PointChoice::kEveryKth, .loss_scale = 1.0},
      // About the start. Its centre and rotation are those of the side that was seen first, so
      // their sigmas are large.
      .prior = {.log_axes = 0.5, .center = 2.0, .rotation = 1.0},
      .prior_without_depth = {.log_axes = 0.15, .center = 2.0, .rotation = 1.0}};
  int max_views = 20;   // evenly chosen
  int iterations = 20;  // at most
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
  double prior_translation = 0.1;  // of the mean distance of the objects
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
  // An object that comes out with a half axis changed by a larger factor is left as it was.
  double max_axis_change = 3.0;
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
  FusionOptions fusion;
  CullingOptions culling;
  MisfitOptions misfit;
  GuideOptions guide;
  ObjectRefinementOptions refinement;
  ObjectPoseOptions pose;
  ObjectBundleOptions bundle;

  void Bind(OptionTable& options);
  // Throws InputError where a use has a residual that cannot be computed from the primitive.
  void Validate() const;
};

}  // namespace hullslam
