// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "hullslam/frame/sensor.h"
#include "hullslam/objects/object_options.h"
#include "optim/bundle_points.h"
#include "optim/robust.h"

namespace hullslam {

// The options of the solver of a bundle adjustment.
struct BundleOptions {
  // The first round uses Huber's loss, and outliers are left out after it. The second round has
  // inliers only and no loss. For a monocular sensor both rounds use Cauchy's loss.
  int robust_iterations = 5;
  int final_iterations = 10;
  double function_tolerance = 1e-4;
  int threads = 1;  // with more than one, the last bits differ from run to run
  // Up to this number of moving keyframes the reduced system of the poses is dense. Among 140 poses
  // nearly all pairs share landmarks, so it is nearly full (docs/performance.md).
  size_t max_dense = 140;
  internal::FollowOptions follow = {};  // of the points, which our own code eliminates
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

// How bundle adjustment depends on the sensor.
struct BundleRules {
  // Whether the solver goes on until a monocular problem is solved (BundleOptions::ForMonocular).
  bool is_solved_precisely = false;
  // Whether keypoints that are near one another in the image share a weight.
  bool keypoints_share_weights = false;
  // Whether the standard deviations of the keypoints are made as small as the errors show them to
  // be. Otherwise they are those of the sensor.
  bool precision_is_measured = false;
  PointLoss robust_loss = PointLoss::kHuber;  // loss of the first round
  PointLoss final_loss = PointLoss::kNone;    // loss of the second round, without outliers
  // Whether the result is scaled to the map if a single keyframe is fixed.
  bool keeps_scale = false;

  static BundleRules ForSensor(const Sensor& sensor) {
    if (!sensor.IsMonocular()) {
      return {};
    }
    if (sensor.depth_error.adjustment_rule == AdjustmentRule::kOrbSlam2) {
      return {.keeps_scale = true};
    }
    // Without depth nothing but the points holds the scale, so a few wrong ones can change it.
    // Corners that slide along edges are such points. Poses follow them, so that their errors are
    // too small for outliers, but not as small as those of others. Under Cauchy's loss such errors
    // pull less than under Huber's.
    return {.is_solved_precisely = true,
            .keypoints_share_weights = true,
            .precision_is_measured = true,
            .robust_loss = PointLoss::kCauchy,
            .final_loss = PointLoss::kCauchy,
            .keeps_scale = true};
  }
};

}  // namespace hullslam
