// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_options.h"

#include <string>
#include <utility>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// What all three uses have.
void BindOutline(OptionTable& options, const std::string& use, Range lines,
                 ObjectConstraintOptions& constraint) {
  const std::string prefix = "objects." + use + ".";
  options.AddEnum(prefix + "residual", &constraint.residual, ObjectResidualNames(),
                  "what is minimised between a quadric and an outline in this use");
  options.AddEnum(prefix + "loss", &constraint.loss, RobustLossNames(),
                  "loss of each residual of an outline in this use");
  options.Add(prefix + "max_effective_lines", &constraint.max_effective_lines, lines,
              "lines that one outline counts as in this use, at most");
}

void BindSigma(OptionTable& options, const std::string& use, ObjectConstraintOptions& constraint) {
  const std::string prefix = "objects." + use + ".";
  options.Add(prefix + "sigma", &constraint.sigma_px, Range::Between(0.1, 100.0),
              "error of an outline in this use, beside the object's misfit, px");
  options.Add(prefix + "misfit_factor", &constraint.misfit_factor, Range::Between(0.0, 100.0),
              "factor of the object's misfit in the error of an outline in this use");
  options.Add(prefix + "loss_scale", &constraint.loss_scale, Range::Between(0.1, 1000.0),
              "error from which on the loss of this use takes effect, sigmas");
}

// What the uses have that move the quadric.
void BindDepthAndPrior(OptionTable& options, const std::string& use,
                       ObjectConstraintOptions& constraint) {
  const std::string prefix = "objects." + use + ".";
  options.Add(prefix + "depth_sigma", &constraint.depth.sigma, Range::Between(0.001, 100.0),
              "error of depth points about the surface of a quadric in this use, m");
  options.Add(prefix + "depth_points", &constraint.depth.max_points, Range::Between(0, 10000),
              "depth points of one detection that are used, at most");
  options.Add(prefix + "prior_sigma", &constraint.prior.log_axes, Range::Between(0.01, 100.0),
              "relative error of the half axes of the prior in this use");
  options.Add(prefix + "prior_sigma_without_depth", &constraint.prior_without_depth.log_axes,
              Range::Between(0.01, 100.0), "the same for an object without depth");
}

void BindAssociation(OptionTable& options, AssociationOptions& association) {
  const auto add = [&](const char* name, auto* field, Range range, const char* help) {
    options.Add(std::string("objects.association.") + name, field, range, help);
  };
  const Range share = Range::Between(0.0, 1.0);
  add("min_projection_iou", &association.min_projection_iou, share,
      "IoU of hull and projected ellipse from which on they match");
  add("min_carried_iou", &association.min_carried_iou, share,
      "IoU of hull and the object's last hull, carried over, from which on they match");
  add("min_depth_iou", &association.min_depth_iou, share,
      "the larger of both from which on they match where depth points agree");
  add("min_shared_landmarks", &association.min_shared_landmarks, Range::Between(1, 1000),
      "landmarks that a detection and an object must share to count");
  add("min_shared_ratio", &association.min_shared_ratio, share,
      "share of landmarks in common from which on they match");
  add("recent_views", &association.recent_views, Range::Between(1, 1000),
      "latest keyframes whose landmarks and centroids stand for an object");
  add("cloud_points", &association.cloud_points, Range::Between(2, 10000),
      "depth points of a cloud that are compared, at most");
  add("min_cloud", &association.min_cloud, Range::Between(2, 10000),
      "depth points that the rank-sum test needs");
  add("max_rank_sum", &association.max_rank_sum, Range::Between(0.0, 100.0),
      "standard score of the rank-sum test up to which two clouds are one");
  add("alpha", &association.alpha, Range::Between(1e-9, 1.0),
      "level of the t-test by which a centroid is one of the object's");
  add("centroid_noise", &association.centroid_noise, Range::Between(1e-6, 10.0),
      "error of a centroid as a share of its distance");
  add("max_offset", &association.max_offset, Range::Between(0.0, 1000.0),
      "distance of the centroids up to which they may match, in sizes of the object");
  add("iou_weight", &association.iou_weight, share, "weight of the larger IoU in the similarity");
  add("landmark_weight", &association.landmark_weight, share,
      "weight of the share of landmarks in common in the similarity");
  add("cloud_weight", &association.cloud_weight, share,
      "weight of one cloud of depth points in the similarity");
  add("centroid_weight", &association.centroid_weight, share,
      "weight of one centroid of depth points in the similarity");
  add("class_weight", &association.class_weight, share,
      "weight of the share of votes for the class in the similarity");
  add("min_similarity", &association.min_similarity, share,
      "similarity from which on a detection is one of a known object");
}

void BindStart(OptionTable& options, StartOptions& start) {
  options.Add("objects.initial_inflation", &start.inflation, Range::Between(0.5, 3.0),
              "half axes that a quadric starts with over those of its points' box");
  options.Add("objects.min_views", &start.min_views, Range::Between(2, 1000),
              "keyframes that an object must be seen in to be mapped");
  options.Add("objects.min_parallax", &start.min_parallax, Range::Between(0.0, 180.0),
              "angle between the views of an object with depth to be mapped, degrees");
  options.Add("objects.min_parallax_blind", &start.min_parallax_without_depth,
              Range::Between(0.0, 180.0), "the same for an object without depth, degrees");
  options.Add("objects.start.max_points", &start.max_points, Range::Between(20, 1000000),
              "depth points from which a quadric starts, about, at most");
  options.Add("objects.start.trimmed", &start.trimmed, Range::Between(0.0, 0.4),
              "share of the depth points left out at each end of each axis");
  options.Add("objects.start.min_half_axis", &start.min_half_axis, Range::Between(1e-6, 10.0),
              "least half axis that a quadric starts with, as a share of its distance");
}

void BindValidity(OptionTable& options, ValidityOptions& validity) {
  options.Add("objects.min_overlap", &validity.min_overlap, Range::Between(0.0, 1.0),
              "mean IoU of projected ellipse and masks' hulls that a mapped object keeps");
  options.Add("objects.min_points_near", &validity.min_points_near, Range::Between(0.0, 1.0),
              "share of depth points in or near a mapped object");
  options.Add("objects.validity.min_half_axis", &validity.min_half_axis,
              Range::Between(0.0, 1000.0),
              "least half axis of a mapped object as a share of its distance");
  options.Add("objects.validity.max_half_axis", &validity.max_half_axis,
              Range::Between(0.0, 1000.0),
              "largest half axis of a mapped object as a share of its distance");
  options.Add("objects.validity.near_surface", &validity.near_surface, Range::Between(0.0, 1000.0),
              "points this far outside of an object are near it, as a share of its distance");
  options.Add("objects.validity.near_surface_share", &validity.near_surface_share,
              Range::Between(0.0, 1000.0), "the same as a share of its mean half axis");
  options.Add("objects.validity.max_stretch", &validity.max_stretch, Range::Between(1.0, 1000.0),
              "half axis of a mapped object over the reach of its points along it, at most");
}

void BindFusion(OptionTable& options, FusionOptions& fusion) {
  const Range share = Range::Between(0.0, 1.0);
  options.Add("objects.fusion.min_overlap", &fusion.min_overlap, share,
              "IoU of the volumes from which on objects never seen together are one");
  options.Add("objects.fusion.min_overlap_together", &fusion.min_overlap_together, share,
              "the same for objects that few keyframes see together");
  options.Add("objects.fusion.max_shared_keyframes", &fusion.max_shared_keyframes, share,
              "share of the keyframes that may see both of two objects that are one");
  options.Add("objects.fusion.alpha", &fusion.alpha, Range::Between(1e-9, 1.0),
              "level of the t-test by which two objects have one centroid");
  options.Add("objects.fusion.centroid_noise", &fusion.centroid_noise, Range::Between(1e-6, 10.0),
              "error of a centroid as a share of its distance");
}

void BindCulling(OptionTable& options, CullingOptions& culling) {
  options.Add("objects.culling.candidate_keyframes", &culling.candidate_keyframes,
              Range::Between(1, 1000000),
              "keyframes without a candidate after which it is removed");
  options.Add("objects.culling.min_visible", &culling.min_visible, Range::Between(1, 1000000),
              "keyframes that should show a mapped object before it can be removed");
  options.Add("objects.culling.min_found_ratio", &culling.min_found_ratio, Range::Between(0.0, 1.0),
              "share of them in which it must be found");
}

void CheckResidual(const std::string& use, ObjectResidual residual, ObjectPrimitive primitive) {
  if (!IsSupported(residual, primitive)) {
    throw InputError("settings: objects." + use + ".residual '" + std::string(NameOf(residual)) +
                     "' cannot be computed from objects.primitive '" +
                     std::string(NameOf(primitive)) + "'");
  }
}

}  // namespace

void ObjectOptions::Bind(OptionTable& options) {
  options.Add("objects.enabled", &enabled, "map objects from their masks");
  options.Add("objects.joint_pose", &joint_pose,
              "outlines of mapped objects constrain each frame's pose");
  options.Add("objects.bundle_adjustment", &bundle_adjustment,
              "adjust quadrics together with poses and landmarks");
  options.Add("objects.misfit_compensation", &misfit_compensation,
              "correct outlines by what other keyframes tell of the object's true shape");
  options.Add("objects.guided_matching", &guided_matching,
              "search landmarks on mapped objects that the local map lacks, within their masks");
  detection.Bind(options);

  BindOutline(options, "refinement", Range::Between(0.1, 1000.0), refinement.constraint);
  BindOutline(options, "pose", Range::Between(0.0, 1000.0), pose.constraint);
  BindOutline(options, "bundle", Range::Between(0.0, 1000.0), bundle.constraint);
  BindSigma(options, "pose", pose.constraint);
  BindSigma(options, "bundle", bundle.constraint);
  BindDepthAndPrior(options, "refinement", refinement.constraint);
  BindDepthAndPrior(options, "bundle", bundle.constraint);
  options.Add("objects.bundle.min_loss_px", &bundle.constraint.min_loss_px,
              Range::Between(0.0, 1000.0),
              "error up to which the loss of this use takes no effect in any case, px");
  options.Add("objects.refinement_sigma", &refinement.max_misfit_px, Range::Between(0.1, 100.0),
              "error of an outline when a quadric is refined, px");
  options.Add("objects.refinement_huber", &refinement.loss_px, Range::Between(0.1, 1000.0),
              "from here on errors count linearly in refinement, px at objects.refinement_sigma");

  options.AddShared(
      "objects.residual",
      {"objects.refinement.residual", "objects.pose.residual", "objects.bundle.residual"},
      "what is minimised between a quadric and an outline");
  options.AddShared("objects.sigma", {"objects.pose.sigma", "objects.bundle.sigma"},
                    "error of an outline in poses, beside the object's misfit, px");
  options.AddShared("objects.max_effective_lines",
                    {"objects.pose.max_effective_lines", "objects.bundle.max_effective_lines"},
                    "lines that one outline counts as in poses, at most");
  options.AddShared("objects.refinement_lines", {"objects.refinement.max_effective_lines"},
                    "lines that one outline counts as in refinement, at most");
  options.AddShared("objects.depth_sigma",
                    {"objects.refinement.depth_sigma", "objects.bundle.depth_sigma"},
                    "error of depth points about the surface of a quadric, m");
  options.AddShared("objects.prior_sigma",
                    {"objects.refinement.prior_sigma", "objects.bundle.prior_sigma"},
                    "relative error of the half axes that a quadric starts with");
  options.AddShared(
      "objects.prior_sigma_blind",
      {"objects.refinement.prior_sigma_without_depth", "objects.bundle.prior_sigma_without_depth"},
      "the same for an object without depth");

  options.Add("objects.refinement.max_views", &refinement.max_views, Range::Between(2, 10000),
              "keyframes by which a quadric is refined, at most");
  options.Add("objects.refinement.iterations", &refinement.iterations, Range::Between(1, 10000),
              "steps of the solver in one refinement, at most");
  options.Add("objects.refinement.min_misfit_px", &refinement.min_misfit_px,
              Range::Between(0.1, 100.0), "error of an outline in refinement, at least, px");
  options.Add("objects.pose.prior_rotation", &pose.prior_rotation, Range::Between(1e-4, 100.0),
              "error of the rotation that a pose with objects starts with, radians");
  options.Add("objects.pose.prior_translation", &pose.prior_translation,
              Range::Between(1e-4, 100.0),
              "error of its position as a share of the objects' mean distance");
  options.Add("objects.pose.min_objects", &pose.min_objects, Range::Between(1, 1000),
              "objects that determine a pose without landmarks");
  options.Add("objects.bundle.max_outer_views", &bundle.max_outer_views, Range::Between(0, 10000),
              "keyframes outside of the window that constrain an object, at most");
  options.Add("objects.bundle.max_axis_change", &bundle.max_axis_change,
              Range::Between(1.0, 1000.0),
              "factor by which bundle adjustment may change a half axis");
  BindAssociation(options, association);
  BindStart(options, start);
  BindValidity(options, validity);
  BindFusion(options, fusion);
  BindCulling(options, culling);
  options.Add("objects.misfit.views", &misfit.views, Range::Between(1, 10000),
              "latest keyframes by which an object's misfit is measured");
  options.Add("objects.misfit.width", &misfit.width, Range::Between(0.1, 45.0),
              "width of the weights of misfit samples, degrees");
  options.Add("objects.guide.views", &guide.views, Range::Between(1, 10000),
              "keyframes by whose masks landmarks on an object are found, at most");
}

void ObjectOptions::Validate() const {
  CheckResidual("refinement", refinement.constraint.residual, detection.primitive);
  CheckResidual("pose", pose.constraint.residual, detection.primitive);
  CheckResidual("bundle", bundle.constraint.residual, detection.primitive);
}

}  // namespace hullslam
