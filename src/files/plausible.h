// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

namespace hullslam {

// Bounds on what files may contain. They are far beyond any real value, but small enough that no
// computation with such numbers overflows.
constexpr double kMostMetres =
    1e8;  // size of a coordinate of a position; the radius of the earth is 6.4e6
constexpr double kMostPixels = 1e6;    // size of a coordinate in an image
constexpr double kMostSeconds = 1e11;  // a time stamp; stamps in milliseconds since 1970 are larger

// Whether a quaternion can be normalised. Files round their numbers, and some contain quaternions
// that are not of unit length, so the bounds are wide.
inline bool IsPlausibleRotation(const Eigen::Quaterniond& rotation) {
  constexpr double kMost = 1e3;
  const double norm = rotation.norm();
  return norm >= 1.0 / kMost && norm <= kMost;
}

}  // namespace hullslam
