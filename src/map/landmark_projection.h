// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/matrix_pose.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/landmark.h"

namespace hullslam {

// The expected view of a landmark by a camera.
struct LandmarkProjection {
  Eigen::Vector3d point_in_cam = Eigen::Vector3d::Zero();  // m
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();         // px, undistorted
  Eigen::Vector2d raw_pixel = Eigen::Vector2d::Zero();     // px
  double cos_view = 0.0;  // cosine of the angle to the landmark's viewing direction
  int level = 0;          // level of the pyramid at which it should be found
};

// Null if the camera cannot recognise the landmark: it is behind the camera or outside the image,
// it is much nearer or farther than it was observed, or the camera sees it from a direction more
// than 60 degrees away from its viewing direction.
std::optional<LandmarkProjection> ProjectLandmark(const Sensor& sensor,
                                                  const MatrixPose& cam_from_world,
                                                  const Landmark& landmark);

}  // namespace hullslam
