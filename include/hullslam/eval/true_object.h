// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// An object as it truly is, of a made-up sequence (docs/synthetic.md).
struct TrueObject {
  uint32_t id = 0;
  std::string label;
  std::string shape;  // ellipsoid, box, superquadric or compound
  bool is_dynamic = false;
  Rigid3 world_from_object;                                // at the start where it moves
  Eigen::Vector3d half_extents = Eigen::Vector3d::Ones();  // m, along the object's axes, tight

  // Mean of the three full extents, m: what errors are shares of.
  double Size() const { return 2.0 * half_extents.mean(); }
};

}  // namespace hullslam
