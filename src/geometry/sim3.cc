// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/sim3.h"

#include <cmath>

namespace hullslam {

Sim3 operator*(const Sim3& c_from_b, const Sim3& b_from_a) {
  return {c_from_b.scale * b_from_a.scale, (c_from_b.rotation * b_from_a.rotation).normalized(),
          c_from_b * b_from_a.translation};
}

Sim3 Inverse(const Sim3& b_from_a) {
  const Eigen::Quaterniond rotation = b_from_a.rotation.conjugate();
  const double scale = 1.0 / b_from_a.scale;
  return {scale, rotation, -scale * (rotation * b_from_a.translation)};
}

Sim3 Retract(const Sim3& b_from_a, const Eigen::Matrix<double, 7, 1>& delta) {
  return Sim3(std::exp(delta[6]), ExpSo3(delta.head<3>()), delta.segment<3>(3)) * b_from_a;
}

}  // namespace hullslam
