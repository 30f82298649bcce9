// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "synthetic/scene.h"

namespace hullslam::synthetic {

// "object 3 on object 5", or "object 3 on support 0". Relations as in docs/scene.md, but from the
// exact surfaces of the objects.
struct TrueRelation {
  int subject = 0;       // SceneObject::id
  std::string relation;  // on, in or beside
  std::optional<int> object;
  std::optional<size_t> support;  // index in Scene::supports; only of "on"
};

// The relations of the objects that do not move, at the start of the sequence, by subject. An
// object is on another one or on a support if its lowest points touch an upper surface of it. It is
// in the other one instead if that surrounds it: at least three of four horizontal rays from its
// centre hit the other one.
std::vector<TrueRelation> FindTrueRelations(const Scene& scene);

}  // namespace hullslam::synthetic
