// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace hullslam {

// A 256-bit rBRIEF descriptor (Rublee et al. 2011), bits in OpenCV's order, as four words.
using Descriptor = std::array<uint64_t, 4>;

// Number of different bits, 0 to 256.
inline int HammingDistance(const Descriptor& a, const Descriptor& b) {
  int distance = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    distance += __builtin_popcountll(a[i] ^ b[i]);
  }
  return distance;
}

struct Keypoint {
  Eigen::Vector2f raw;          // px in the image as read
  Eigen::Vector2f undistorted;  // px after undistortion
  float angle = 0.0f;           // radians, clockwise from +x in the image (y down), 0 to 2 pi
  float response = 0.0f;        // FAST score
  int level = 0;                // of the pyramid
};

// The image pyramid's geometry: level l is smaller by scale[l] = factor^l.
struct ScaleLevels {
  std::vector<float> scale;           // 1, 1.2, 1.44 ...
  std::vector<float> sigma2;          // px^2: scale^2, variance of a keypoint's position
  std::vector<float> inverse_sigma2;  // 1 / px^2
  float log_factor = 0.0f;            // ln(factor)

  // At least one level and a factor above 1, else CheckError is thrown.
  static ScaleLevels Create(int levels, double factor);
  int count() const { return static_cast<int>(scale.size()); }
  // The level at which a patch looks as at its own level when seen from `distance`, where
  // `max_distance` is that from which it is seen at level 0: between two levels the upper one (so
  // it is seen at this level or the one below), clamped to the levels there are. Distances are
  // positive, else CheckError is thrown.
  int PredictLevel(double distance, double max_distance) const;
};

}  // namespace hullslam
