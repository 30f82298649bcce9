// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/geometry/trajectory.h"

namespace hullslam {

// Converts the pose (R, t) of a camera whose y axis points up to a right-handed camera (y
// down) that sees the same pixels in the mirrored world. With F = diag(1, -1, 1) the new pose is (F
// R F, F t): a point X of the world becomes F X, and X_c in the camera frame becomes F X_c. So the
// row v = cy - fy Y / Z of the camera with y up is cy + fy Y' / Z' with Y' = -Y and Z' = Z.
Rigid3 MirrorY(const Rigid3& world_from_cam);
Trajectory MirrorY(Trajectory trajectory);

}  // namespace hullslam
