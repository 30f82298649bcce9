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

  options.Add("objects.initial_inflation", &start.inflation, Range::Between(0.5, 3.0),
              "half axes that a quadric starts with over those of its points' box");
  options.Add("objects.min_views", &start.min_views, Range::Between(2, 1000),
              "keyframes that an object must be seen in to be mapped");
  options.Add("objects.min_parallax", &start.min_parallax, Range::Between(0.0, 180.0),
              "angle between the views of an object with depth to be mapped, degrees");
  options.Add("objects.min_parallax_blind", &start.min_parallax_without_depth,
              Range::Between(0.0, 180.0), "the same for an object without depth, degrees");
  options.Add("objects.min_overlap", &validity.min_overlap, Range::Between(0.0, 1.0),
              "mean IoU of projected ellipse and masks' hulls that a mapped object keeps");
  options.Add("objects.min_points_near", &validity.min_points_near, Range::Between(0.0, 1.0),
              "share of depth points in or near a mapped object");
}

void ObjectOptions::Validate() const {
  CheckResidual("refinement", refinement.constraint.residual, detection.primitive);
  CheckResidual("pose", pose.constraint.residual, detection.primitive);
  CheckResidual("bundle", bundle.constraint.residual, detection.primitive);
}

}  // namespace hullslam
