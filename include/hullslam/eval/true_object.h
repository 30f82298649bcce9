// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// A true object of a synthetic sequence (docs/synthetic.md).
struct TrueObject {
  uint32_t id = 0;
  std::string label;
  std::string shape;  // ellipsoid, box, superquadric or compound
  bool is_dynamic = false;
  Rigid3 world_from_object;  // at the start of the sequence if it moves
  Eigen::Vector3d half_extents = Eigen::Vector3d::Ones();  // m, tight, along the axes of the object

  // Mean of the three full extents, m. Relative errors are divided by this.
  double Size() const { return 2.0 * half_extents.mean(); }
};

}  // namespace hullslam
