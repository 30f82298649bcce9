// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// Adds a room of 7 m x 6.4 m with painted walls and a carpet. In its middle is an office table,
// whose top is 0.74 m high. Returns the textures.
Palette FurnishOfficeTable(SceneBuilder& builder);

}  // namespace hullslam::synthetic
