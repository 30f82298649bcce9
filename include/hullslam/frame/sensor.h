// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/features/feature_set.h"

namespace hullslam {

enum class SensorKind {
  kRgbd,
  // A monocular camera. The unit of length of its map is not known in metres; it is the median
  // depth of the first points.
  kMonocular,
};

// The properties of the camera that are the same for all frames of a run.
struct Sensor {
  SensorKind kind = SensorKind::kRgbd;
  PinholeCamera camera;
  PinholeCamera::Bounds bounds;  // bounds of the undistorted image, px
  ScaleLevels levels;
  double close_depth = 0.0;  // m; smaller depths are precise enough for a landmark from one view
  DepthErrorOptions depth_error;
  double frames_per_second = 30.0;
  // Time from the exposure of the first row of an image to that of the last one, s. 0 for a global
  // shutter, which exposes all rows at the same time.
  double readout_time = 0.0;

  bool IsMonocular() const { return kind == SensorKind::kMonocular; }
  // Baseline of the virtual stereo pair, m; 0 for a monocular camera.
  double baseline() const { return IsMonocular() ? 0.0 : camera.bf / camera.fx; }
};

}  // namespace hullslam
