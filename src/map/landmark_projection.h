// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/landmark.h"

namespace hullslam {

// A landmark as a camera should see it.
struct LandmarkView {
  Eigen::Vector3d point_in_cam = Eigen::Vector3d::Zero();  // m
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();         // px, undistorted
  double right_u = 0.0;                                    // px in the virtual right image
  double cos_view = 0.0;  // of the angle to the mean direction it was seen from
  int level = 0;          // of the pyramid at which its patch should look alike
};

// Nothing where the camera cannot recognise it: behind or outside the image, much nearer or farther
// than it was seen from, or from a direction more than 60 degrees off.
std::optional<LandmarkView> ViewLandmark(const Sensor& sensor, const Rigid3& cam_from_world,
                                         const Landmark& landmark);

}  // namespace hullslam
