// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// Adds a plain room of 6.4 m x 6 m with a large teddy bear on a low table in its middle. All other
// objects are concave too.
void FurnishTeddyRoom(SceneBuilder& builder);

}  // namespace hullslam::synthetic
