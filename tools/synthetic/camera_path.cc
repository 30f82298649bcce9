// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/camera_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "hullslam/util/check.h"
#include "synthetic/hash_noise.h"
#include "util/hash.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

}  // namespace

Rigid3 LookAt(const Vector3d& eye, const Vector3d& target) {
  Eigen::Matrix3d world_from_cam;
  const Vector3d forward = (target - eye).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  world_from_cam << right, forward.cross(right), forward;
  return {Eigen::Quaterniond(world_from_cam).normalized(), eye};
}

HandMotion::HandMotion(uint64_t seed) {
  RandomStream random(seed);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 3; ++column) {
      phases_(row, column) = random.Uniform(0.0, kTwoPi);
    }
  }
}

Rigid3 HandMotion::Apply(const Rigid3& world_from_cam, double time) const {
  // Frequencies in hertz. Higher frequencies have smaller amplitudes, so that the accelerations are
  // about those of a hand.
  constexpr std::array<double, 3> kFrequency = {0.23, 0.61, 1.3};
  constexpr std::array<double, 3> kStrength = {1.0, 0.35, 0.08};
  Eigen::Matrix<double, 6, 1> wave = Eigen::Matrix<double, 6, 1>::Zero();
  for (int row = 0; row < 6; ++row) {
    for (size_t i = 0; i < kFrequency.size(); ++i) {
      const double phase = phases_(row, static_cast<Eigen::Index>(i));
      // Each axis has slightly different frequencies, so that the sum does not repeat.
      const double frequency = kFrequency[i] * (1.0 + 0.07 * row);
      wave[row] += kStrength[i] * std::sin(kTwoPi * frequency * time + phase);
    }
  }
  const Rigid3 motion(ExpSo3(0.014 * wave.tail<3>()), 0.015 * wave.head<3>());
  return world_from_cam * motion;
}

std::function<Rigid3(double)> ByHand(std::function<Rigid3(double)> path, uint64_t visit) {
  const HandMotion hand(HashSeed(visit, 0, "hand"));
  return [path = std::move(path), hand](double time) { return hand.Apply(path(time), time); };
}

HandTurns::HandTurns(uint64_t seed) {
  RandomStream random(seed);
  for (int axis = 0; axis < 3; ++axis) {
    for (int column = 0; column < 2; ++column) {
      phases_(axis, column) = random.Uniform(0.0, kTwoPi);
    }
  }
}

Rigid3 HandTurns::Apply(const Rigid3& world_from_cam, double time) const {
  // Two sines per axis (x: nodding, y: to the sides, z: about the optical axis). The speeds are the
  // largest ones in rad/s; their sum is 2.0 rad/s about y and at most 3.2 rad/s about all axes.
  // Hands turn to and fro about once a second.
  constexpr std::array<std::array<double, 2>, 3> kSpeed = {{{1.0, 0.6}, {1.2, 0.8}, {1.1, 0.7}}};
  constexpr std::array<std::array<double, 2>, 3> kHertz = {
      {{0.71, 1.33}, {0.62, 1.17}, {0.79, 1.45}}};
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t i = 0; i < 2; ++i) {
      const double rate = kTwoPi * kHertz[axis][i];
      const auto row = static_cast<Eigen::Index>(axis);
      const double phase = phases_(row, static_cast<Eigen::Index>(i));
      angles[row] += kSpeed[axis][i] / rate * std::sin(rate * time + phase);
    }
  }
  return world_from_cam * Rigid3(ExpSo3(angles), Eigen::Vector3d::Zero());
}

Rigid3 OrbitPath::WorldFromCam(double time) const {
  const double angle = start_angle + angular_speed * time;
  const double distance = radius * (1.0 + 0.08 * std::sin(0.8 * time));
  const Vector3d eye(distance * std::cos(angle), distance * std::sin(angle),
                     height + 0.07 * std::sin(0.6 * time + 1.0));
  const Vector3d sway(0.10 * std::sin(0.5 * time), 0.06 * std::cos(0.4 * time), 0.0);
  return LookAt(eye, target + sway);
}

Rigid3 SweepPath::WorldFromCam(double time) const {
  const double phase = kTwoPi * frequency * time;
  const double angle = middle_angle + swing * std::sin(phase);
  const double distance = radius * (1.0 + 0.15 * std::sin(0.6 * phase + 1.0));
  const Vector3d eye(distance * std::cos(angle), distance * std::sin(angle),
                     height + 0.12 * std::sin(1.4 * phase));
  const Vector3d sway(0.15 * std::sin(0.8 * phase), 0.05 * std::cos(0.5 * phase), 0.0);
  return LookAt(eye, target + sway);
}

Rigid3 LoopPath::WorldFromCam(double time) const {
  constexpr double kOverlap = 0.35;  // radians beyond a full turn
  const double angle = start_angle + (kTwoPi + kOverlap) * time / duration;
  const Vector3d eye(radius.x() * std::cos(angle), radius.y() * std::sin(angle), height);
  const Vector3d outwards(std::cos(angle), std::sin(angle), -0.22);
  return LookAt(eye, eye + outwards);
}

WaypointPath::WaypointPath(const std::vector<Waypoint>& waypoints, double walking, double turning) {
  Check(waypoints.size() >= 2, "a path needs at least two waypoints");
  constexpr double kRadians = std::numbers::pi / 180.0;
  double time = 0.0;
  for (size_t i = 0; i < waypoints.size(); ++i) {
    const Waypoint& here = waypoints[i];
    if (i > 0) {
      const Waypoint& last = waypoints[i - 1];
      const double walk = (here.eye - last.eye).norm() / walking;
      const double turn =
          std::max(std::abs(here.yaw - last.yaw), std::abs(here.pitch - last.pitch)) / turning;
      time += std::max({walk, turn, here.seconds});
      Check(time > times_.back(), "neighbouring waypoints are the same");
    }
    times_.push_back(time);
    values_.emplace_back();
    values_.back() << here.eye, kRadians * here.yaw, kRadians * here.pitch;
  }
}

WaypointPath::Values WaypointPath::Slope(size_t index) const {
  if (index == 0 || index + 1 == values_.size()) {
    return Values::Zero();  // the camera starts and stops gently
  }
  const double before = times_[index] - times_[index - 1];
  const double after = times_[index + 1] - times_[index];
  const Values slope_before = (values_[index] - values_[index - 1]) / before;
  const Values slope_after = (values_[index + 1] - values_[index]) / after;
  return (after * slope_before + before * slope_after) / (before + after);
}

Rigid3 WaypointPath::WorldFromCam(double time) const {
  const double inside = std::clamp(time, 0.0, times_.back());
  const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, inside);
  const auto end = static_cast<size_t>(next - times_.begin());
  const double span = times_[end] - times_[end - 1];
  const double t = (inside - times_[end - 1]) / span;
  const double blend = t * t * (3.0 - 2.0 * t);
  const Values at = (1.0 - blend) * values_[end - 1] + blend * values_[end] +
                    span * t * (1.0 - t) * ((1.0 - t) * Slope(end - 1) - t * Slope(end));
  const Vector3d eye = at.head<3>();
  const Vector3d forward(std::cos(at[4]) * std::cos(at[3]), std::cos(at[4]) * std::sin(at[3]),
                         std::sin(at[4]));
  return LookAt(eye, eye + forward);
}

PacedPath::PacedPath(WaypointPath path, double seconds)
    : path_(std::move(path)), pace_(path_.duration() / seconds) {
  Check(seconds > 0.0, "a walk needs some time");
}

}  // namespace hullslam::synthetic
