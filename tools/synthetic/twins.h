// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/camera_path.h"
#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// The second of the twin rooms is a copy of the first one at this distance along +x. Metres.
inline constexpr double kTwinDistance = 4.4;

// Adds two rooms with the same walls, textures, posters and furniture on one side of a corridor.
// Only their objects differ.
void FurnishTwins(SceneBuilder& builder);

// Looks around in the first room, walks along the corridor, and looks around in the second room in
// the same way.
WaypointPath TwinsPath();

}  // namespace hullslam::synthetic
