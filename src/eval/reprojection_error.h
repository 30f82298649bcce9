// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "hullslam/camera/pinhole.h"
#include "hullslam/map/map.h"

namespace hullslam {

// The median distance between the keypoints of all keyframes and the projections of the landmarks
// that they show, in undistorted pixels. Absent if no landmark is observed. It can be used to
// compare two models of the same camera: the better model has the smaller error.
std::optional<double> MedianReprojectionError(const Map& map, const PinholeCamera& camera);

}  // namespace hullslam
