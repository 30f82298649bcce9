// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "hullslam/costs/object_residual.h"

namespace hullslam {

// The robust loss of the residuals of one line or one point (ceres::LossFunction).
enum class RobustLoss { kNone, kHuber, kCauchy, kTukey };

// The names in settings, in the order of the enumerators: none, huber, cauchy, tukey.
std::vector<std::string> RobustLossNames();

// The unit of a sigma: pixels, which are converted to the unit of the residual for the object's
// size and distance, or the unit of the residual itself, as in systems with one weight for all
// objects.
enum class SigmaUnit { kPixels, kResidual };

// The names in settings, in the order of the enumerators: pixels, residual.
std::vector<std::string> SigmaUnitNames();

// The choice of depth points when a detection has more than the largest number: exactly that
// number, evenly spread, or every k-th point.
enum class PointChoice { kEven, kEveryKth };

// The constraint on an object from the depth points of one detection.
struct ObjectDepthOptions {
  double sigma = 0.10;  // m, of the distance of a point from the surface
  // The sigma for a landmark, as a share of its distance. Landmarks are used if there is no depth.
  double landmark_sigma = 0.05;
  int max_points = 0;  // per detection; 0: depth is not used
  PointChoice choice = PointChoice::kEven;
  double max_effective_points = 1.0;  // the points of one detection count as at most this many
  RobustLoss loss = RobustLoss::kCauchy;
  double loss_scale = 2.5;  // sigmas
};

// The constraint of one detection on an object and the pose of the camera, and the prior of the
// object.
struct ObjectConstraintOptions {
  ObjectResidual residual = ObjectResidual::kTangent;
  // The sigma of a line is hypot(sigma_px, misfit_factor * misfit of the object), px. With the unit
  // kResidual it is sigma_px, in the unit of the residual.
  double sigma_px = 0.5;
  SigmaUnit sigma_unit = SigmaUnit::kPixels;
  double misfit_factor = 1.0;
  // The lines of one detection count as at most this many independent lines, because their errors
  // are strongly correlated.
  double max_effective_lines = 8.0;
  RobustLoss loss = RobustLoss::kCauchy;
  double loss_scale = 2.5;   // sigmas
  double min_loss_px = 0.0;  // least loss scale, px
  ObjectDepthOptions depth = {};
  QuadricPriorSigmas prior = {};
  QuadricPriorSigmas prior_without_depth = {.log_axes = 0.15};
};

}  // namespace hullslam
