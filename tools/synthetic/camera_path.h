// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "hullslam/geometry/rigid3.h"

namespace hullslam::synthetic {

// Pose of a camera at `eye` whose optical axis goes through `target`, with the image upright (world
// z up).
Rigid3 LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

// The shaking of a hand, which is added to a steady path: sums of slow sines with phases from the
// seed. The camera moves by about 1.5 cm and turns by about 0.8 degrees.
class HandMotion {
 public:
  explicit HandMotion(uint64_t seed);
  // Adds the hand motion at `time` (seconds) to the pose, in the camera frame.
  Rigid3 Apply(const Rigid3& world_from_cam, double time) const;

 private:
  Eigen::Matrix<double, 6, 3> phases_;
};

// The pose of the camera as a function of the time in seconds, on a path with the shaking of a
// hand. Visits of a scene differ in `visit`.
std::function<Rigid3(double)> ByHand(std::function<Rigid3(double)> path, uint64_t visit);
template <typename Path>
requires requires(const Path& path) { path.WorldFromCam(0.0); }
std::function<Rigid3(double)> ByHand(const Path& path, uint64_t visit) {
  return ByHand([path](double time) { return path.WorldFromCam(time); }, visit);
}

// Fast turns of a hand to and fro about all axes of the camera, which are added to a path. The
// angular velocity is smooth, usually 1 to 3 rad/s and never above 3.2 rad/s, and its directions
// come from phases that depend on the seed.
class HandTurns {
 public:
  explicit HandTurns(uint64_t seed);
  // Turns the camera about its centre by what the hand has turned it at `time` (seconds).
  Rigid3 Apply(const Rigid3& world_from_cam, double time) const;

 private:
  Eigen::Matrix<double, 3, 2> phases_;
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

// A path to and fro on an arc around a table, as of somebody who looks at it from both sides. The
// camera looks at the middle of the table.
struct SweepPath {
  double radius = 1.35;        // metres from the axis, on average
  double height = 1.3;         // metres, on average
  double middle_angle = -1.6;  // radians from +x
  double swing = 0.6;          // radians to either side
  double frequency = 0.13;     // sweeps there and back per second
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

// A place that the camera passes, and where it looks there.
struct Waypoint {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  double yaw = 0.0;      // degrees from +x towards +y; a path may go beyond 360
  double pitch = 0.0;    // degrees, negative to look down
  double seconds = 0.0;  // least time from the previous waypoint; not used for the first one
};

// A smooth walk through waypoints. Between neighbours each coordinate is a cubic polynomial whose
// slopes at the waypoints come from the parabola through three neighbours (cubic Hermite spline).
class WaypointPath {
 public:
  // Between two waypoints the mean speed is at most `walking` (metres per second) and the mean turn
  // at most `turning` (degrees per second). Throws CheckError for fewer than two waypoints.
  WaypointPath(const std::vector<Waypoint>& waypoints, double walking, double turning);

  // Seconds until the last waypoint.
  double duration() const { return times_.back(); }
  // The camera rests at the first waypoint before time 0, and at the last waypoint after
  // duration().
  Rigid3 WorldFromCam(double time) const;

 private:
  using Values = Eigen::Matrix<double, 5, 1>;  // x, y, z in metres, yaw and pitch in radians
  Values Slope(size_t index) const;

  std::vector<double> times_;
  std::vector<Values> values_;
};

// The same walk in another time.
class PacedPath {
 public:
  // `seconds`: until the last waypoint. Throws CheckError unless it is positive.
  PacedPath(WaypointPath path, double seconds);
  Rigid3 WorldFromCam(double time) const { return path_.WorldFromCam(pace_ * time); }

 private:
  WaypointPath path_;
  double pace_;  // planned seconds per second
};

}  // namespace hullslam::synthetic
