// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_options.h"

namespace hullslam {

void ObjectOptions::Bind(OptionTable& options) {
  options.Add("objects.enabled", &enabled, "map objects from their masks");
  options.Add("objects.joint_pose", &joint_pose,
              "outlines of mapped objects hold each frame's pose");
  options.Add("objects.bundle_adjustment", &bundle_adjustment,
              "adjust quadrics together with poses and landmarks");
  options.Add("objects.misfit_compensation", &misfit_compensation,
              "correct outlines by what other keyframes tell of the object's true shape");
  options.Add("objects.guided_matching", &guided_matching,
              "search landmarks on mapped objects that the local map lacks, within their masks");
  options.AddEnum("objects.residual", &residual, ObjectResidualNames(),
                  "what is minimised between a quadric and an outline");
  detection.Bind(options);
  options.Add("objects.refinement_sigma", &refinement_sigma, Range::Between(0.1, 100.0),
              "error of an outline when a quadric is refined, px");
  options.Add("objects.refinement_huber", &refinement_huber, Range::Between(0.1, 1000.0),
              "from here on errors count linearly in refinement, px at objects.refinement_sigma");
  options.Add("objects.refinement_lines", &refinement_lines, Range::Between(0.1, 1000.0),
              "lines that one outline counts as in refinement, at most");
  options.Add("objects.depth_sigma", &depth_sigma, Range::Between(0.001, 100.0),
              "error of depth points about the surface of a quadric, m");
  options.Add("objects.prior_sigma", &prior_sigma, Range::Between(0.01, 100.0),
              "relative error of the half axes that a quadric starts with");
  options.Add("objects.prior_sigma_blind", &prior_sigma_blind, Range::Between(0.01, 100.0),
              "the same for an object without depth");
  options.Add("objects.initial_inflation", &initial_inflation, Range::Between(0.5, 3.0),
              "half axes that a quadric starts with over those of its points' box");
  options.Add("objects.min_views", &min_views, Range::Between(2, 1000),
              "keyframes that an object must be seen in to be mapped");
  options.Add("objects.min_parallax", &min_parallax, Range::Between(0.0, 180.0),
              "angle between the views of an object with depth to be mapped, degrees");
  options.Add("objects.min_parallax_blind", &min_parallax_blind, Range::Between(0.0, 180.0),
              "the same for an object without depth, degrees");
  options.Add("objects.min_overlap", &min_overlap, Range::Between(0.0, 1.0),
              "mean IoU of outline and masks' hulls that a mapped object keeps");
  options.Add("objects.min_points_near", &min_points_near, Range::Between(0.0, 1.0),
              "share of depth points in or near a mapped object");
  options.Add("objects.sigma", &sigma, Range::Between(0.1, 100.0),
              "error of an outline in poses, beside the object's misfit, px");
  options.Add("objects.max_effective_lines", &max_effective_lines, Range::Between(0.0, 1000.0),
              "lines that one outline counts as in poses, at most");
}

}  // namespace hullslam
