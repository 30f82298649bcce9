// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "optim/robust.h"

namespace hullslam {

// How bundle adjustment depends on the sensor.
struct BundleRules {
  // Whether the solver goes on until a monocular problem is solved (BundleOptions::WithoutDepth).
  bool is_solved_precisely = false;
  // Whether keypoints at the same place of the image share a weight.
  bool keypoints_share_weights = false;
  // Whether the standard deviations of the keypoints are made as small as the errors show them to
  // be. Otherwise they are those of the sensor.
  bool precision_is_measured = false;
  PointLoss robust_loss = PointLoss::kHuber;  // of the first round
  PointLoss final_loss = PointLoss::kNone;    // of the second round, without outliers
  // Whether the result is scaled to the map if a single keyframe is fixed.
  bool keeps_scale = false;

  static BundleRules ForSensor(SensorKind kind) {
    if (kind != SensorKind::kMonocular) {
      return {};
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
