// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "hullslam/geometry/rigid3.h"
#include "synthetic/scene.h"

namespace hullslam::synthetic {

// The least distance by which an object is moved, in metres: its longest side, but at least 0.15 m.
double LeastMove(const SceneObject& object);

// Whether the boxes of two objects that stand upright come nearer than `gap` metres to each other.
// Boxes that only touch do not collide if the gap is zero.
bool Collide(const SceneObject& a, const SceneObject& b, double gap);

// Changes the scene as its inhabitants do between two visits: a fifth of the objects that can be
// carried, but at least two, are moved, as many are taken away, and as many are added. Tables,
// shelves, beds and couches stay, and so do objects that hang on a wall or carry other objects.
//
// An object that stood on the floor is moved to the floor, one that stood on a table is moved to a
// table, both by at most 3 m. Added objects are copies of objects of the scene in other colours.
// The new place of an object is free, is seen by the camera, is not in the way of the camera, and
// is at least LeastMove away from all former places of objects of its class. `views` are the poses
// of the camera along its path. Objects keep their ids; added ones get new ids. If an object has no
// such place, another object is chosen.
void Rearrange(std::span<const Rigid3> views, uint64_t seed, Scene& scene);

}  // namespace hullslam::synthetic
