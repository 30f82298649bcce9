// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_options.h"

#include <string>
#include <utility>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// The keys that all three uses have.
void BindOutline(OptionTable& options, const std::string& use, Range lines,
                 ObjectConstraintOptions& constraint) {
  const std::string prefix = "objects." + use + ".";
  options.AddEnum(prefix + "residual", &constraint.residual, ObjectResidualNames(),
                  "residual that is minimised between a quadric and a detection");
  options.AddEnum(prefix + "loss", &constraint.loss, RobustLossNames(),
                  "robust loss of each residual");
  options.Add(prefix + "max_effective_lines", &constraint.max_effective_lines, lines,
              "largest number of effective lines per detection");
}

void BindSigma(OptionTable& options, const std::string& use, ObjectConstraintOptions& constraint) {
  const std::string prefix = "objects." + use + ".";
  options.Add(prefix + "sigma", &constraint.sigma_px, Range::Between(0.1, 100.0),
              "standard deviation of a line, in addition to the misfit of the object, px");
  options.Add(prefix + "misfit_factor", &constraint.misfit_factor, Range::Between(0.0, 100.0),
              "factor of the misfit of the object in the standard deviation of a line");
  options.Add(prefix + "loss_scale", &constraint.loss_scale, Range::Between(0.1, 1000.0),
              "scale of the robust loss, in standard deviations");
}

// The keys of the uses that change quadrics.
void BindDepthAndPrior(OptionTable& options, const std::string& use,
                       ObjectConstraintOptions& constraint) {
  const std::string prefix = "objects." + use + ".";
  options.Add(
      prefix + "depth_sigma", &constraint.depth.sigma, Range::Between(0.001, 100.0),
      "standard deviation of the distance of depth points from the surface of a quadric, m");
  options.Add(prefix + "depth_points", &constraint.depth.max_points, Range::Between(0, 10000),
              "largest number of depth points that are used per detection");
  options.Add(prefix + "prior_sigma", &constraint.prior.log_axes, Range::Between(0.01, 100.0),
              "standard deviation of the log half axes in the prior about a quadric");
  options.Add(prefix + "prior_sigma_without_depth", &constraint.prior_without_depth.log_axes,
              Range::Between(0.01, 100.0),
              "standard deviation of the log half axes in the prior about a quadric, for an object "
              "without depth");
}

void BindAssociation(OptionTable& options, AssociationOptions& association) {
  const auto add = [&](const char* name, auto* field, Range range, const char* help) {
    options.Add(std::string("objects.association.") + name, field, range, help);
  };
  const Range share = Range::Between(0.0, 1.0);
  add("min_projection_iou", &association.min_projection_iou, share,
      "a detection matches an object if the IoU of its hull and the projected ellipse is at least "
      "this");
  add("min_carried_iou", &association.min_carried_iou, share,
      "a detection matches an object if the IoU of its hull and the object's last hull, moved to "
      "the new pose, is at least this");
  add("min_depth_iou", &association.min_depth_iou, share,
      "if the depth points agree, a detection matches an object if the larger of the two IoUs is "
      "above this");
  add("min_shared_landmarks", &association.min_shared_landmarks, Range::Between(1, 1000),
      "if a detection and an object have fewer common landmarks, their share of common landmarks "
      "counts as 0");
  add("min_shared_ratio", &association.min_shared_ratio, share,
      "a detection matches an object if their share of common landmarks is at least this");
  add("recent_views", &association.recent_views, Range::Between(1, 1000),
      "number of the latest keyframes whose landmarks and centroids represent an object");
  add("cloud_points", &association.cloud_points, Range::Between(2, 10000),
      "approximate largest number of depth points of a cloud that are compared");
  add("min_cloud", &association.min_cloud, Range::Between(2, 10000),
      "number of depth points that each cloud needs for the rank-sum test");
  add("max_rank_sum", &association.max_rank_sum, Range::Between(0.0, 100.0),
      "two clouds agree if the rank-sum test gives at most this standard score on each axis");
  add("alpha", &association.alpha, Range::Between(1e-9, 1.0),
      "significance level of the t-test whether a centroid belongs to an object");
  add("centroid_noise", &association.centroid_noise, Range::Between(1e-6, 10.0),
      "standard deviation of a centroid of depth points, as a share of its distance");
  add("max_offset", &association.max_offset, Range::Between(0.0, 1000.0),
      "largest distance between the centroids of a match, in units of the object's size");
  add("iou_weight", &association.iou_weight, share, "weight of the larger IoU in the similarity");
  add("landmark_weight", &association.landmark_weight, share,
      "weight of the share of common landmarks in the similarity");
  add("cloud_weight", &association.cloud_weight, share,
      "weight of agreeing clouds of depth points (rank-sum test) in the similarity");
  add("centroid_weight", &association.centroid_weight, share,
      "weight of agreeing centroids of depth points (t-test) in the similarity");
  add("class_weight", &association.class_weight, share,
      "weight of the share of votes for the detection's class in the similarity");
  add("min_similarity", &association.min_similarity, share,
      "least similarity of a detection and an object that are matched");
}

void BindStart(OptionTable& options, StartOptions& start) {
  options.Add("objects.initial_inflation", &start.inflation, Range::Between(0.5, 3.0),
              "half axes of the start of a quadric in relation to those of the box of its points");
  options.Add("objects.min_views", &start.min_views, Range::Between(2, 1000),
              "number of keyframes that must observe an object before it is mapped");
  options.Add("objects.min_parallax", &start.min_parallax, Range::Between(0.0, 180.0),
              "least angle between views that an object with depth needs to be mapped, degrees");
  options.Add("objects.min_parallax_blind", &start.min_parallax_without_depth,
              Range::Between(0.0, 180.0),
              "least angle between views that an object without depth needs to be mapped, degrees");
  options.Add("objects.start.max_points", &start.max_points, Range::Between(20, 1000000),
              "approximate largest number of depth points from which a start is computed");
  options.Add("objects.start.trimmed", &start.trimmed, Range::Between(0.0, 0.4),
              "share of the depth points that is left out at each end of each axis");
  options.Add("objects.start.min_half_axis", &start.min_half_axis, Range::Between(1e-6, 10.0),
              "least half axis of a start, as a share of its distance");
}

void BindValidity(OptionTable& options, ValidityOptions& validity) {
  options.Add("objects.min_overlap", &validity.min_overlap, Range::Between(0.0, 1.0),
              "least mean IoU of projected ellipse and hull for a mapped object");
  options.Add("objects.min_points_near", &validity.min_points_near, Range::Between(0.0, 1.0),
              "least share of depth points inside or near a mapped object");
  options.Add("objects.validity.min_half_axis", &validity.min_half_axis,
              Range::Between(0.0, 1000.0),
              "least half axis of a mapped object as a share of its distance");
  options.Add("objects.validity.max_half_axis", &validity.max_half_axis,
              Range::Between(0.0, 1000.0),
              "largest half axis of a mapped object as a share of its distance");
  options.Add(
      "objects.validity.near_surface", &validity.near_surface, Range::Between(0.0, 1000.0),
      "points up to this far outside an object are near it, as a share of the object's distance");
  options.Add(
      "objects.validity.near_surface_share", &validity.near_surface_share,
      Range::Between(0.0, 1000.0),
      "points up to this far outside an object are near it, as a share of its mean half axis");
  options.Add(
      "objects.validity.max_stretch", &validity.max_stretch, Range::Between(1.0, 1000.0),
      "largest ratio of a half axis of a mapped object to the extent of its depth points along it");
  options.Add(
      "objects.validity.max_misfit", &validity.max_misfit, Range::Between(0.0, 100.0),
      "largest RMS distance of the outlines of a mapped object from its projected ellipses, "
      "as a share of the size of its masks");
  options.Add("objects.validity.max_elongation", &validity.max_elongation,
              Range::Between(1.0, 1000.0),
              "a mapped object that is longer along the view than across it by a larger factor "
              "needs more parallax");
  options.Add("objects.validity.elongation_parallax", &validity.elongation_parallax,
              Range::Between(0.0, 180.0),
              "angle between the views that such an object needs, degrees per elongation");
}

void BindFusion(OptionTable& options, FusionOptions& fusion) {
  const Range share = Range::Between(0.0, 1.0);
  options.Add("objects.fusion.min_overlap", &fusion.min_overlap, share,
              "two objects that were never seen together are fused if the IoU of their volumes is "
              "at least this");
  options.Add("objects.fusion.min_overlap_together", &fusion.min_overlap_together, share,
              "two objects that few keyframes see together are fused if the IoU of their volumes "
              "is at least this");
  options.Add(
      "objects.fusion.max_shared_keyframes", &fusion.max_shared_keyframes, share,
      "two objects are not fused if a larger share of the keyframes of either observes both");
  options.Add("objects.fusion.alpha", &fusion.alpha, Range::Between(1e-9, 1.0),
              "significance level of the t-test whether two objects have the same centroid");
  options.Add("objects.fusion.centroid_noise", &fusion.centroid_noise, Range::Between(1e-6, 10.0),
              "standard deviation of a centroid of depth points, as a share of its distance");
}

void BindCulling(OptionTable& options, CullingOptions& culling) {
  options.Add("objects.culling.candidate_keyframes", &culling.candidate_keyframes,
              Range::Between(1, 1000000),
              "a candidate is removed if it was last seen more than this many keyframes ago");
  options.Add("objects.culling.min_visible", &culling.min_visible, Range::Between(1, 1000000),
              "keyframes that should show a mapped object before it can be removed");
  options.Add("objects.culling.min_found_ratio", &culling.min_found_ratio, Range::Between(0.0, 1.0),
              "a mapped object is removed if it is found in a smaller share of the keyframes that "
              "should show it");
  options.Add("objects.culling.max_range", &culling.max_range, Range::Between(0.0, 1000.0),
              "a keyframe should show an object only up to this many times the largest distance at "
              "which the object was observed");
  options.Add("objects.culling.max_hidden", &culling.max_hidden, Range::Between(0.0, 1.0),
              "a keyframe should show an object only if at most this share of it is hidden");
}

void BindChanges(OptionTable& options, ChangeOptions& changes) {
  options.Add("objects.changes.min_keyframes", &changes.min_keyframes, Range::Between(1, 1000000),
              "keyframes that should show an object before it is called gone or new");
  options.Add("objects.changes.max_found_ratio", &changes.max_found_ratio, Range::Between(0.0, 1.0),
              "an object is gone or new if it is found in a smaller share of these keyframes");
  options.Add(
      "objects.changes.min_overlap", &changes.min_overlap, Range::Between(0.0, 1.0),
      "least IoU of the projected ellipse of an object and the hull of a mask that shows it");
  options.Add("objects.changes.min_inside", &changes.min_inside, Range::Between(0.0, 1.0),
              "a keyframe should show an object if at least this share of it is in the image");
  options.Add("objects.changes.min_seen_through", &changes.min_seen_through,
              Range::Between(0.0, 1.0),
              "or its place counts as seen if this share of what is behind it was measured");
  options.Add("objects.changes.max_move", &changes.max_move, Range::Between(0.0, 1e6),
              "an object is taken for one that was moved only up to this distance, m");
  options.Add("objects.changes.max_size_ratio", &changes.max_size_ratio, Range::Between(1.0, 100.0),
              "largest ratio of the half axes of an object before and after it was moved");
}

void CheckResidual(const std::string& use, ObjectResidual residual, ObjectPrimitive primitive) {
  if (!AcceptsPrimitive(residual, primitive)) {
    throw InputError("settings: objects." + use + ".residual '" + std::string(NameOf(residual)) +
                     "' cannot be computed from objects.primitive '" +
                     std::string(NameOf(primitive)) + "'");
  }
}

}  // namespace

void ObjectOptions::Bind(OptionTable& options) {
  options.Add("objects.enabled", &enabled, "map objects from their masks");
  options.Add("objects.joint_pose", &joint_pose, "mapped objects constrain the pose of each frame");
  options.Add("objects.bundle_adjustment", &bundle_adjustment,
              "adjust quadrics together with poses and landmarks");
  options.Add("objects.misfit_compensation", &misfit_compensation,
              "correct lines by the excess that other keyframes measured");
  options.Add("objects.guided_matching", &guided_matching,
              "search landmarks on mapped objects that are not in the local map, inside the hulls "
              "of their detections");
  options.Add("objects.sizes", &sizes, Range::Between(0.001, 1000.0),
              "longest side of objects by class, m; a single camera without depth gets its scale "
              "from objects of known size");
  detection.Bind(options);

  BindOutline(options, "refinement", Range::Between(0.1, 1000.0), refinement.constraint);
  BindOutline(options, "pose", Range::Between(0.0, 1000.0), pose.constraint);
  BindOutline(options, "bundle", Range::Between(0.0, 1000.0), bundle.constraint);
  BindSigma(options, "pose", pose.constraint);
  BindSigma(options, "bundle", bundle.constraint);
  BindDepthAndPrior(options, "refinement", refinement.constraint);
  BindDepthAndPrior(options, "bundle", bundle.constraint);
  options.Add(
      "objects.refinement.landmark_sigma", &refinement.constraint.depth.landmark_sigma,
      Range::Between(0.001, 100.0),
      "standard deviation of the distance of landmarks from the surface of a quadric without "
      "depth, as a share of their distance from the camera");
  options.Add("objects.bundle.min_loss_px", &bundle.constraint.min_loss_px,
              Range::Between(0.0, 1000.0), "least scale of the robust loss, px");
  options.Add("objects.refinement_sigma", &refinement.max_misfit_px, Range::Between(0.1, 100.0),
              "largest standard deviation of a line when a quadric is refined, px");
  options.Add("objects.refinement_huber", &refinement.loss_px, Range::Between(0.1, 1000.0),
              "scale of the robust loss in refinement, px, for a line with the standard deviation "
              "objects.refinement_sigma");

  options.AddShared(
      "objects.residual",
      {"objects.refinement.residual", "objects.pose.residual", "objects.bundle.residual"},
      "residual that is minimised between a quadric and a detection");
  options.AddShared("objects.sigma", {"objects.pose.sigma", "objects.bundle.sigma"},
                    "standard deviation of a line in joint pose and bundle adjustment, in addition "
                    "to the misfit of the object, px");
  options.AddShared(
      "objects.max_effective_lines",
      {"objects.pose.max_effective_lines", "objects.bundle.max_effective_lines"},
      "largest number of effective lines per detection, in joint pose and bundle adjustment");
  options.AddShared("objects.refinement_lines", {"objects.refinement.max_effective_lines"},
                    "largest number of effective lines per detection, in refinement");
  options.AddShared(
      "objects.depth_sigma", {"objects.refinement.depth_sigma", "objects.bundle.depth_sigma"},
      "standard deviation of the distance of depth points from the surface of a quadric, m");
  options.AddShared("objects.prior_sigma",
                    {"objects.refinement.prior_sigma", "objects.bundle.prior_sigma"},
                    "standard deviation of the log half axes in the prior about a quadric");
  options.AddShared(
      "objects.prior_sigma_blind",
      {"objects.refinement.prior_sigma_without_depth", "objects.bundle.prior_sigma_without_depth"},
      "standard deviation of the log half axes in the prior about a quadric, for an object without "
      "depth");

  options.Add("objects.refinement.max_views", &refinement.max_views, Range::Between(2, 10000),
              "largest number of keyframes that are used to refine a quadric");
  options.Add("objects.refinement.iterations", &refinement.iterations, Range::Between(1, 10000),
              "largest number of iterations of the solver per refinement");
  options.Add("objects.refinement.min_misfit_px", &refinement.min_misfit_px,
              Range::Between(0.1, 100.0),
              "least standard deviation of a line when a quadric is refined, px");
  options.Add("objects.pose.prior_rotation", &pose.prior_rotation, Range::Between(1e-4, 100.0),
              "standard deviation of the prior on the rotation of a pose with objects, radians");
  options.Add("objects.pose.prior_translation", &pose.prior_translation,
              Range::Between(1e-4, 100.0),
              "standard deviation of the prior on the position of a pose with objects, as a share "
              "of their mean distance");
  options.Add("objects.pose.min_objects", &pose.min_objects, Range::Between(1, 1000),
              "number of objects that are enough to determine a pose without landmarks");
  options.Add("objects.bundle.max_outer_views", &bundle.max_outer_views, Range::Between(0, 10000),
              "largest number of keyframes outside the window that constrain an object");
  options.Add("objects.bundle.max_axis_change", &bundle.max_axis_change,
              Range::Between(1.0, 1000.0),
              "a quadric is left as it was if bundle adjustment changes a half axis by more than "
              "this factor");
  BindAssociation(options, association);
  BindStart(options, start);
  BindValidity(options, validity);
  BindFusion(options, fusion);
  BindCulling(options, culling);
  BindChanges(options, changes);
  options.Add("objects.misfit.views", &misfit.views, Range::Between(1, 10000),
              "number of the latest keyframes that measure the misfit of an object");
  options.Add("objects.misfit.width", &misfit.width, Range::Between(0.1, 45.0),
              "standard deviation of the Gaussian weights of misfit samples, degrees");
  options.Add(
      "objects.guide.views", &guide.views, Range::Between(1, 10000),
      "largest number of keyframes whose masks are used to find the landmarks on an object");
}

void ObjectOptions::Validate() const {
  CheckResidual("refinement", refinement.constraint.residual, detection.primitive);
  CheckResidual("pose", pose.constraint.residual, detection.primitive);
  CheckResidual("bundle", bundle.constraint.residual, detection.primitive);
}

}  // namespace hullslam
