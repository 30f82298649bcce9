// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/costs/object_residual.h"
#include "hullslam/frame/detection_options.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// Objects as landmarks: what they take part in, and how their shape is found. Which outlines hold
// them is in DetectionOptions.
struct ObjectOptions {
  bool enabled = true;
  bool joint_pose = true;         // lines of mapped objects hold the pose of each frame
  bool bundle_adjustment = true;  // quadrics are moved together with poses and points
  bool misfit_compensation = true;
  bool guided_matching = true;  // landmarks on objects that the local map lacks are searched
  ObjectResidual residual = ObjectResidual::kTangent;
  DetectionOptions detection;

  // Refinement: a quadric alone, poses fixed.
  double refinement_sigma = 5.0;    // px, of a line
  double refinement_huber = 8.0;    // px
  double refinement_lines = 4.0;    // one detection weighs at most so many lines
  double depth_sigma = 0.10;        // m, of depth points about the surface
  double prior_sigma = 0.5;         // relative, of the half axes about the start
  double prior_sigma_blind = 0.15;  // the same for an object without depth
  double initial_inflation = 1.2;   // of the oriented bounding box of the points

  // What a candidate needs to be mapped.
  int min_views = 3;                 // keyframes
  double min_parallax = 3.0;         // degrees between viewing rays, with depth
  double min_parallax_blind = 15.0;  // without
  double min_overlap = 0.6;          // mean IoU of outline and hull
  double min_points_near = 0.4;      // share of depth points in the quadric or near its surface

  // Weight of objects in poses and in bundle adjustment.
  double sigma = 0.5;                // px, of a line, beside the object's misfit
  double max_effective_lines = 8.0;  // of one detection

  void Bind(OptionTable& options);
};

}  // namespace hullslam
