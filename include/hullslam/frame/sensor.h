// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/features/feature_set.h"

namespace hullslam {

// What all frames of a run have in common.
struct Sensor {
  PinholeCamera camera;
  PinholeCamera::Bounds bounds;  // of the undistorted image, px
  ScaleLevels levels;
  double close_depth = 0.0;  // m; nearer depths are precise enough for a landmark from one view
  DepthErrorOptions depth_error;
  double frames_per_second = 30.0;

  double baseline() const { return camera.bf / camera.fx; }  // m
};

}  // namespace hullslam
