// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "hullslam/geometry/rigid3.h"
#include "synthetic/scene.h"

namespace hullslam::synthetic {

// How far an object is moved at least, in metres: its longest side, or 0.15 m if that is more.
double LeastMove(const SceneObject& object);

// Whether the boxes of two objects that stand upright come nearer than `gap` metres to each other.
// Boxes that only touch do not collide if the gap is zero.
bool Collide(const SceneObject& a, const SceneObject& b, double gap);

// Changes the scene as its inhabitants do between two visits: a fifth of the objects that can be
// carried, but at least two, are moved, as many are taken away, and as many are added. Tables,
// shelves, beds, couches, what hangs on a wall and what carries something stay.
//
// Moved objects stay on the floor or on tables, whichever they were on, within 3 m. Added objects
// are copies of objects of the scene in other colours. Each gets a free place where the camera,
// whose poses on its way are `views`, sees it and does not bump into it, and which is at least
// LeastMove from all former places of objects of its class. Objects keep their ids; added ones get
// new ids. If there is no such place for an object, another object is chosen.
void Rearrange(std::span<const Rigid3> views, uint64_t seed, Scene& scene);

}  // namespace hullslam::synthetic
