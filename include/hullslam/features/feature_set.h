// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace hullslam {

// A 256-bit rBRIEF descriptor (Rublee et al. 2011), as four words. The bits are in the order of
// OpenCV.
using Descriptor = std::array<uint64_t, 4>;

// Number of different bits, 0 to 256.
inline int HammingDistance(const Descriptor& a, const Descriptor& b) {
  int distance = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    distance += __builtin_popcountll(a[i] ^ b[i]);
  }
  return distance;
}

// The data of a keypoint that a keyframe keeps.
struct Keypoint {
  Eigen::Vector2f undistorted;  // px after undistortion
  float angle = 0.0f;           // radians, clockwise from +x in the image (y down), 0 to 2 pi
  int level = 0;                // level of the pyramid
};

// A keypoint in the image as read.
struct RawKeypoint {
  Eigen::Vector2f raw;    // px
  float angle = 0.0f;     // as in Keypoint
  float response = 0.0f;  // FAST score
  int level = 0;          // level of the pyramid
};

// Geometry of the image pyramid: level l is smaller than level 0 by the factor scale[l] = factor^l.
struct ScaleLevels {
  std::vector<float> scale;           // 1, 1.2, 1.44 ...
  std::vector<float> sigma2;          // px^2: scale^2, variance of a keypoint's position
  std::vector<float> inverse_sigma2;  // 1 / px^2
  float log_factor = 0.0f;            // ln(factor)

  // Throws CheckError unless there is at least one level and the factor is above 1.
  static ScaleLevels Create(int levels, double factor);
  int count() const { return static_cast<int>(scale.size()); }
  // Predicts the level at which a patch is found when it is seen from `distance`, if it is found at
  // level 0 from `max_distance`. Between two levels the upper one is returned, so the patch is
  // found at this level or at the one below. The result is clamped to the existing levels. Throws
  // CheckError unless both distances are positive.
  int PredictLevel(double distance, double max_distance) const;
};

}  // namespace hullslam
