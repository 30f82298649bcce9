// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// Similarity transform of points: x_b = scale * rotation * x_a + translation for a Sim3 named
// `b_from_a`. One unit of length of frame a is `scale` units of frame b.
struct Sim3 {
  double scale = 1.0;  // > 0
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Sim3() = default;
  Sim3(double scale_in, const Eigen::Quaterniond& rotation_in,
       const Eigen::Vector3d& translation_in)
      : scale(scale_in), rotation(rotation_in), translation(translation_in) {}
  // The similarity of scale 1.
  explicit Sim3(const Rigid3& rigid) : rotation(rigid.rotation), translation(rigid.translation) {}

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return scale * (rotation * point) + translation;
  }
};

// c_from_a = c_from_b * b_from_a. The rotation of the product has unit norm.
Sim3 operator*(const Sim3& c_from_b, const Sim3& b_from_a);

Sim3 Inverse(const Sim3& b_from_a);

// Applies a small similarity on the left, after `b_from_a`: x_b is rotated by delta[0..2]
// (radians), multiplied by exp(delta[6]) and then moved by delta[3..5]. The derivative at zero is
// dx_b / ddelta = [-Skew(x_b), I, x_b]. With delta[6] = 0 the scale stays the same to the last bit.
Sim3 Retract(const Sim3& b_from_a, const Eigen::Matrix<double, 7, 1>& delta);

}  // namespace hullslam
