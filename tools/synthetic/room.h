// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// Adds a room of 6 m x 5 m with furniture and objects along its four walls.
void FurnishRoom(SceneBuilder& builder);

}  // namespace hullslam::synthetic
