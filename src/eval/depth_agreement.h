// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>

#include "hullslam/camera/pinhole.h"
#include "hullslam/map/map.h"

namespace hullslam {

// How well the measured depth of keypoints agrees with the depth that follows from their positions
// in two images.
struct DepthAgreement {
  double deviation = 0.0;  // median of |measured / triangulated - 1|
  size_t points = 0;       // measured depths that were compared
};

// Each landmark is triangulated from its first and its last keyframe, by the poses of the map and
// the keypoints alone, if its rays meet at an angle of at least 3 degrees. Absent without any
// measured depth to compare. The deviation grows if the depth image is not registered to the colour
// image, or if the camera has other intrinsics than `camera`. It stays the same if all depths have
// the same wrong scale, because the poses then have that scale too.
std::optional<DepthAgreement> CompareDepth(const Map& map, const PinholeCamera& camera);

}  // namespace hullslam
