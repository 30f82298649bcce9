// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace hullslam {

// The rotation of a matrix in a file, whose numbers are rounded; nothing if it is none.
inline std::optional<Eigen::Quaterniond> RotationOf(const Eigen::Matrix3d& matrix) {
  constexpr double kTolerance = 1e-3;
  const bool is_rotation =
      (matrix * matrix.transpose()).isApprox(Eigen::Matrix3d::Identity(), kTolerance) &&
      matrix.determinant() > 0.0;
  return is_rotation ? std::optional(Eigen::Quaterniond(matrix).normalized()) : std::nullopt;
}

}  // namespace hullslam
