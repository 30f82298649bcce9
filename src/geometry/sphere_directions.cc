// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/sphere_directions.h"

#include <cmath>
#include <numbers>

namespace hullslam {

Eigen::Vector3d SphereDirection(int index, int count) {
  const double z = 1.0 - (2.0 * index + 1.0) / count;
  const double angle = index * std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace hullslam
