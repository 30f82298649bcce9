// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "camera/point_measurement.h"

namespace hullslam {

// A landmark found in the image.
struct PoseObservation {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // m, world frame
  PointMeasurement measurement;
};

}  // namespace hullslam
