// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The change of an object between two visits of a synthetic scene.
enum class TrueObjectStatus { kUnchanged, kMoved, kNew };

// A true object of a synthetic sequence (docs/synthetic.md).
struct TrueObject {
  uint32_t id = 0;  // the same in all visits of a scene
  std::string label;
  std::string shape;  // ellipsoid, box, superquadric or compound
  bool is_dynamic = false;
  Rigid3 world_from_object;  // at the start of the sequence if it moves
  Eigen::Vector3d half_extents = Eigen::Vector3d::Ones();  // m, tight, along the axes of the object
  std::optional<TrueObjectStatus> status;                  // only in a rearranged scene
  std::optional<Rigid3> former_world_from_object;          // pose before; only of a moved object

  // Mean of the three full extents, m. Relative errors are divided by this.
  double Size() const { return 2.0 * half_extents.mean(); }
};

// The true objects of a synthetic sequence, and those that a rearrangement of the scene took away.
struct TrueScene {
  bool is_rearranged = false;
  std::vector<TrueObject> objects;
  std::vector<TrueObject> gone;  // with their former poses; empty unless the scene was rearranged
};

}  // namespace hullslam
