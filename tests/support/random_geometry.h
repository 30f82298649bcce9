// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <random>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// Random numbers, vectors and poses from a seed, for tests of laws.
class RandomGeometry {
 public:
  explicit RandomGeometry(uint32_t seed) : generator_(seed) {}

  double Number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  // An integer from 0 to count - 1.
  uint32_t Index(size_t count) { return static_cast<uint32_t>(generator_() % count); }
  Eigen::Vector3d Vector(double reach) {
    return {Number(-reach, reach), Number(-reach, reach), Number(-reach, reach)};
  }
  Rigid3 Pose(double angle, double distance) { return {ExpSo3(Vector(angle)), Vector(distance)}; }

 private:
  std::mt19937 generator_;
};

}  // namespace hullslam
