// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/camera_path.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "synthetic/hash_noise.h"

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
  // Frequencies in hertz. The amplitude falls with the frequency, so that the accelerations are
  // those of a hand.
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

Rigid3 OrbitPath::WorldFromCam(double time) const {
  const double angle = start_angle + angular_speed * time;
  const double distance = radius * (1.0 + 0.08 * std::sin(0.8 * time));
  const Vector3d eye(distance * std::cos(angle), distance * std::sin(angle),
                     height + 0.07 * std::sin(0.6 * time + 1.0));
  const Vector3d sway(0.10 * std::sin(0.5 * time), 0.06 * std::cos(0.4 * time), 0.0);
  return LookAt(eye, target + sway);
}

Rigid3 LoopPath::WorldFromCam(double time) const {
  constexpr double kOverlap = 0.35;  // radians beyond a full turn
  const double angle = start_angle + (kTwoPi + kOverlap) * time / duration;
  const Vector3d eye(radius.x() * std::cos(angle), radius.y() * std::sin(angle), height);
  const Vector3d outwards(std::cos(angle), std::sin(angle), -0.22);
  return LookAt(eye, eye + outwards);
}

}  // namespace hullslam::synthetic
