// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "hullslam/objects/object_options.h"
#include "optim/bundle_points.h"

namespace hullslam {

// The options of the solver of a bundle adjustment.
struct BundleOptions {
  // The first round uses Huber's loss, and outliers are left out after it. The second round has
  // inliers only and no loss. For a monocular sensor both rounds use Cauchy's loss.
  int robust_iterations = 5;
  int final_iterations = 10;
  double function_tolerance = 1e-4;
  int threads = 1;  // with more than one, the last bits differ from run to run
  // Up to this number of moving keyframes our own code eliminates the landmarks; with more
  // keyframes Ceres does. Among 140 poses nearly all pairs share landmarks, so the reduced system
  // is nearly full, and a dense solver is faster (docs/performance.md).
  size_t max_eliminated = 140;
  internal::FollowOptions follow = {};  // of points that our own code eliminates
  ObjectBundleOptions objects = {};

  // These options for a whole map. When a step would change the cost by a smaller share than the
  // tolerance, the solver ends without taking it. In a global adjustment the terms that correct
  // drift are a small share of the cost, so the tolerance must be small.
  BundleOptions ForWholeMap() const;
  // These options for a monocular sensor, with a tolerance at least as small as that of a whole
  // map. Where the camera hardly moves, a change of the depths can compensate for a change of the
  // motion, so the cost changes little on the way to its minimum.
  BundleOptions ForMonocular() const;
};

}  // namespace hullslam
