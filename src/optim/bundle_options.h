// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "hullslam/objects/object_options.h"
#include "optim/bundle_points.h"

namespace hullslam {

// How the problem of a bundle adjustment is solved.
struct BundleOptions {
  // With Huber's loss; then outliers are left out. Without depth, Cauchy's loss in both rounds.
  int robust_iterations = 5;
  int final_iterations = 10;  // without loss, inliers only
  double function_tolerance = 1e-4;
  int threads = 1;  // with more than one, the last bits differ from run to run
  // With up to this number of moving keyframes, own code eliminates the landmarks; with more, Ceres
  // does. Nearly all of 140 poses share landmarks, so the system that is left without the landmarks
  // is nearly full, and a dense solver is faster (docs/performance.md).
  size_t max_eliminated = 140;
  internal::FollowOptions follow = {};  // of points that own code eliminates
  ObjectBundleOptions objects = {};

  // These options for a whole map. A step that changes the cost by less than the tolerance is not
  // taken. In a global adjustment the terms that correct drift are a small share of the cost, so
  // the tolerance must be small.
  BundleOptions ForWholeMap() const;
  // These options without depth, at least as precise as those of a whole map. Where the camera
  // hardly moves, depths and motions can stand for each other, and the cost changes little on the
  // way to its minimum.
  BundleOptions ForMonocular() const;
};

}  // namespace hullslam
