// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/camera_path.h"
#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// Adds an office of 7.6 m x 7.2 m with painted walls and a carpet. In its middle are two desks back
// to back.
void FurnishOfficeLoop(SceneBuilder& builder);

// Once around the desks and 20 degrees more, so that the start is seen again. The camera looks at
// the desks. `seconds`: the time for the whole path.
OrbitPath OfficeLoopPath(double seconds);

}  // namespace hullslam::synthetic
