// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/camera_path.h"
#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// Adds an office of 5 m x 4.4 m. Two of its walls have desks, a shelf and posters; the other two
// and the ceiling are plain.
void FurnishIclOffice(SceneBuilder& builder);

// The path of one of four sequences (0 to 3) in this office. Throws CheckError for other numbers. 0
// and 2 stay with the desks; 1 and 3 turn to the plain walls and come back.
WaypointPath IclOfficePath(int number);

}  // namespace hullslam::synthetic
