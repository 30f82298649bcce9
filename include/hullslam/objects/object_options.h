// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "hullslam/frame/detection_options.h"
#include "hullslam/objects/object_constraint_options.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// Lengths are given as shares of the object's distance from the cameras, so that they also make
// sense in a map of unknown scale. Each struct binds those of its fields that are settings, in the
// scope of its own path; the others are fixed.

// How a detection and an object are compared (src/objects/comparison/association_measure.h).
enum class AssociationMeasure { kCombined, kClassOverlap, kWasserstein };

// How the first quadric of an object is made (src/objects/start_method.h).
enum class ObjectStart { kFitted, kOrientedBox, kBoxPlanes, kRaySphere, kSingleView };

// The conditions for a detection to show an object of the map; see AssociateDetections.
struct AssociationOptions {
  // All other options are those of kCombined.
  AssociationMeasure measure = AssociationMeasure::kCombined;
  double min_projection_iou = 0.25;  // IoU of hull and projected ellipse
  double min_carried_iou = 0.5;      // IoU of the hull and the last hull moved to the new pose
  double min_depth_iou = 0.1;        // the larger of the two IoUs, if the depth points agree
  int min_shared_landmarks = 3;
  double min_shared_ratio =
      0.5;                      // common landmarks over the smaller number of landmarks of the two
  int recent_views = 5;         // number of latest keyframes that represent an object
  int cloud_points = 40;        // approximate largest number of points of a cloud that are compared
  int min_cloud = 20;           // number of points that the rank-sum test needs
  double max_rank_sum = 1.282;  // standard score
  double alpha = 0.001;         // significance level of the t-test of centroids
  double centroid_noise = 0.02;  // sigma of a centroid, as a share of its distance
  double max_offset = 1.0;       // between centroids, in sizes of the object
  // Weights in the similarity of a match: the larger IoU, shared landmarks, agreeing clouds,
  // agreeing centroids, votes for the class.
  double iou_weight = 0.6;
  double landmark_weight = 0.2;
  double cloud_weight = 0.1;
  double centroid_weight = 0.1;
  double class_weight = 0.2;
  double min_similarity = 0.2;  // least similarity of a matched detection and object

  void Bind(const OptionScope& scope);
};

// The conditions for computing the shape of a candidate, and its start.
struct StartOptions {
  ObjectStart method = ObjectStart::kFitted;
  int min_views = 3;  // keyframes
  // Degrees between viewing rays, with depth. Depth tells where an object is, and max_elongation
  // guards its extent along the view, so the views need only differ: at 3 degrees 78 of 115
  // visible objects of eight sequences were mapped, at 1 degree 101, and one of them twice at 0.
  double min_parallax = 1.0;
  double min_parallax_without_depth = 15.0;  // degrees
  int max_points = 2000;                     // approximate largest number of depth points
  double trimmed = 0.03;        // share of the points that is left out at each end of each axis
  double inflation = 1.2;       // factor on the oriented bounding box of the points
  double min_half_axis = 0.01;  // share of the distance to the object, for flat things

  void Bind(const OptionScope& scope);
};

// The conditions that a mapped object must satisfy; see FindObjection.
struct ValidityOptions {
  double min_half_axis = 0.005;     // share of the distance to the object
  double max_half_axis = 3.0;       // share of the distance to the object
  double min_overlap = 0.6;         // mean IoU of projected ellipse and hull
  double min_points_near = 0.4;     // share of depth points inside the quadric or near its surface
  double near_surface = 0.03;       // near: outside by at most this share of the distance
  double near_surface_share = 0.2;  // or by at most this share of the mean half axis
  double max_stretch = 2.5;         // half axis over the extent of the points along it
  double max_misfit = 0.25;         // RMS distance of lines from the ellipse over the mask's size
  // The elongation of a quadric is how much longer it is along the mean viewing direction than
  // across it. Flat quadrics are common, so their elongation is a quarter of how much shorter they
  // are. An elongation above `max_elongation` is valid only if the angle between the views is
  // large enough to observe it: this many degrees per elongation.
  double max_elongation = 1.5;
  double elongation_parallax = 6.0;

  void Bind(const OptionScope& scope);
};

// The conditions for fusing two objects; see FindDuplicates.
struct FusionOptions {
  double min_overlap = 0.25;          // IoU of the volumes if no keyframe sees both objects
  double min_overlap_together = 0.5;  // least overlap if few keyframes see both objects
  double max_shared_keyframes = 0.2;  // share of the keyframes of the object that has fewer
  double alpha = 0.05;                // significance level of the t-test of centroids
  double centroid_noise = 0.02;       // sigma of a centroid, as a share of its distance

  void Bind(const OptionScope& scope);
};

// The conditions for removing an object.
struct CullingOptions {
  int candidate_keyframes = 20;  // removes candidates last seen more keyframes ago than this
  // A mapped object is removed if it is found in a smaller share of the keyframes that should show
  // it. There must be at least `min_visible` of them.
  int min_visible = 10;
  double min_found_ratio = 0.25;
  // A keyframe should show an object only if the object is at most this many times as far away as
  // in the farthest keyframe that observes it, and if at most this share of it is hidden.
  double max_range = 1.25;
  double max_hidden = 0.3;

  void Bind(const OptionScope& scope);
};

// The conditions for an object of a loaded map to count as gone or new; see FindObjectChanges.
struct ChangeOptions {
  int min_keyframes = 3;         // least number of keyframes that should show the object
  double max_found_ratio = 0.2;  // it is found in a smaller share of these keyframes
  double min_overlap = 0.25;     // IoU of its projected ellipse and a hull that may show it
  double min_inside = 0.6;       // share of the object that must be in the image
  // The location of an object also counts as seen if the depth image shows this share of the
  // surfaces behind it.
  double min_seen_through = 0.8;
  // An object that is farther away than this (m; in the unit of the map if its scale is unknown)
  // cannot be the one that is gone.
  double max_move = 4.0;
  double max_size_ratio = 2.5;  // ratio of half axes before and after a move

  void Bind(const OptionScope& scope);
};

// The measurement of the misfit of an object; see misfit.h.
struct MisfitOptions {
  int views = 40;      // number of latest keyframes that samples are taken from
  double width = 4.0;  // degrees, sigma of the Gaussian weights of the samples
};

// The search for landmarks on an object, for guided matching.
struct GuideOptions {
  int views = 20;  // largest number of keyframes whose masks are used
};

// Refinement: one quadric is optimised, poses are fixed. The sigma of a line is the object's
// misfit, clamped to [min_misfit_px, max_misfit_px].
struct ObjectRefinementOptions {
  // Its loss_scale is not used: see loss_px.
  ObjectConstraintOptions constraint = {
      .sigma_px = 0.0,
      .max_effective_lines = 4.0,
      .loss = RobustLoss::kHuber,
      .depth = {.max_points = 20, .choice = PointChoice::kEveryKth, .loss_scale = 1.0},
      // The centre of the prior is the start. The start represents only the side that was seen
      // first, so the sigmas of centre and rotation are large.
      .prior = {.log_axes = 0.5, .center = 2.0, .rotation = 1.0},
      .prior_without_depth = {.log_axes = 0.15, .center = 2.0, .rotation = 1.0}};
  int max_views = 20;   // keyframes, evenly chosen
  int iterations = 20;  // largest number of iterations of the solver
  double min_misfit_px = 1.0;
  double max_misfit_px = 5.0;  // also used for a start, whose misfit is not known yet
  double loss_px = 8.0;        // loss scale of a line whose sigma is max_misfit_px

  void Bind(const OptionScope& scope);
};

// Joint pose estimation: the pose is optimised, objects are fixed. Depth points and the prior of
// the object are not used.
struct ObjectPoseOptions {
  // An object is left out if half of its residuals exceed the loss scale.
  ObjectConstraintOptions constraint = {};
  // Sigmas of a prior that keeps the pose near its initial value. It is only used if there are
  // objects, and it is weak compared with one object or a few points. It constrains the motions
  // that objects alone do not determine, such as the rotation around a single object and the
  // common distance of all objects.
  double prior_rotation = 0.1;     // radians
  double prior_translation = 0.1;  // share of the mean distance of the objects
  int min_objects = 2;             // number of objects that determine a pose without points

  void Bind(const OptionScope& scope);
};

// Bundle adjustment: quadrics, poses and landmarks are optimised together. Detections in keyframes
// outside the window are used too, with fixed poses. Without them, a few new views would not
// determine the whole quadric.
struct ObjectBundleOptions {
  ObjectConstraintOptions constraint = {
      // The misfit of an object is similar in similar views.
      .misfit_factor = 2.0,       .loss = RobustLoss::kTukey, .loss_scale = 6.0,
      .min_loss_px = 15.0,  // with a smaller scale the shape gets worse
      .depth = {.max_points = 6},
      // The prior is about the quadric at the beginning of the adjustment. It damps the parameters
      // that the views do not determine. A prior about the start, which shows only the side that
      // was seen first, would bias the poses.
  };
  int max_outer_views = 5;  // keyframes outside the window, evenly chosen
  // A quadric is left as it was if the adjustment changes a half axis by a larger factor.
  double max_axis_change = 3.0;

  void Bind(const OptionScope& scope);
};

// All options of objects as landmarks.
struct ObjectOptions {
  bool enabled = true;
  bool joint_pose = true;         // mapped objects constrain the pose of each frame
  bool bundle_adjustment = true;  // quadrics are adjusted together with poses and landmarks
  bool misfit_compensation = true;
  bool guided_matching = true;  // search landmarks on objects that are not in the local map
  // Longest side (m) by class. In a monocular map, objects of known size make the unit of length 1
  // m.
  std::map<std::string, double> sizes;
  DetectionOptions detection;
  AssociationOptions association;
  StartOptions start;
  ValidityOptions validity;
  FusionOptions fusion;
  CullingOptions culling;
  ChangeOptions changes;
  MisfitOptions misfit;
  GuideOptions guide;
  ObjectRefinementOptions refinement;
  ObjectPoseOptions pose;
  ObjectBundleOptions bundle;

  // Binds the keys `objects.*`; a key is the path of the field, as in `objects.start.min_views`.
  // Earlier names of the keys work too.
  void Bind(OptionTable& options);
  // Throws InputError if the residual of a use cannot be computed from the primitive.
  void Validate() const;

 private:
  void BindShared(const OptionScope& scope);
};

}  // namespace hullslam
