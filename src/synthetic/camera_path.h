// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "hullslam/geometry/rigid3.h"

namespace hullslam::synthetic {

// Pose of a camera at `eye` whose optical axis goes through `target`, with the image upright (world
// z up).
Rigid3 LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

// The shaking of a hand, added to a steady path: sums of slow sines with phases from the seed,
// about 1.5 cm and 0.8 degrees.
class HandMotion {
 public:
  explicit HandMotion(uint64_t seed);
  // Adds the hand motion at `time` (seconds) to the pose, in the camera frame.
  Rigid3 Apply(const Rigid3& world_from_cam, double time) const;

 private:
  Eigen::Matrix<double, 6, 3> phases_;
};

// A path around a table. The camera looks at the middle of the table from a changing distance and
// height.
struct OrbitPath {
  double radius = 1.4;           // metres from the axis, on average
  double height = 1.32;          // metres
  double start_angle = -2.3;     // radians from +x
  double angular_speed = 0.165;  // radians per second
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Rigid3 WorldFromCam(double time) const;
};

// A path around a room, slightly more than a full turn, so that the start is seen again. The camera
// looks outwards.
struct LoopPath {
  Eigen::Vector2d radius{0.8, 0.6};  // metres
  double height = 1.4;
  double start_angle = 1.2;  // radians from +x
  double duration = 20.0;    // seconds
  Rigid3 WorldFromCam(double time) const;
};

}  // namespace hullslam::synthetic
