// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/camera_path.h"
#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// Adds four furnished rooms, which lie on both sides of a corridor, with about sixty objects: an
// office and a living room to the north (+y), a bedroom and a kitchen to the south.
void FurnishHouse(SceneBuilder& builder);

// A tour of the house: office, corridor, living room, kitchen, bedroom, corridor, and office again.
// In its last two seconds the camera sees again what it saw in the first two.
WaypointPath HousePath();

}  // namespace hullslam::synthetic
