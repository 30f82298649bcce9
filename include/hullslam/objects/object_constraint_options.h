// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "hullslam/costs/object_residual.h"
#include "hullslam/costs/quadric_prior_sigmas.h"

namespace hullslam {

// What a large residual of one line or one point counts (ceres::LossFunction).
enum class RobustLoss { kNone, kHuber, kCauchy, kTukey };

// All names in settings, in the order of the enumerators: none, huber, cauchy, tukey.
std::vector<std::string> RobustLossNames();

// Which of the depth points of a detection are used: as many as allowed, or every k-th.
enum class PointChoice { kEven, kEveryKth };

// How the depth points of one detection constrain an object.
struct ObjectDepthOptions {
  double sigma = 0.10;  // m, of depth points about the surface
  int max_points = 0;   // of one detection; 0: depth is not used
  PointChoice choice = PointChoice::kEven;
  double max_effective_points = 1.0;  // the points of one detection count as so many at most
  RobustLoss loss = RobustLoss::kCauchy;
  double loss_scale = 2.5;  // sigmas
};

// How one detection constrains an object and the pose it is seen from, and the prior on the object.
struct ObjectConstraintOptions {
  ObjectResidual residual = ObjectResidual::kTangent;
  // The sigma of an outline is hypot(sigma_px, misfit_factor * misfit of the object), px.
  double sigma_px = 0.5;
  double misfit_factor = 1.0;
  // The errors of the lines of one detection are strongly correlated: they count as so many lines
  // at most.
  double max_effective_lines = 8.0;
  RobustLoss loss = RobustLoss::kCauchy;
  double loss_scale = 2.5;   // sigmas
  double min_loss_px = 0.0;  // the loss scale is at least so many pixels
  ObjectDepthOptions depth = {};
  QuadricPriorSigmas prior = {};
  QuadricPriorSigmas prior_without_depth = {.log_axes = 0.15};
};

}  // namespace hullslam
