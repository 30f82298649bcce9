// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "objects/resolved_observation.h"

namespace hullslam {

// The hull of the last of the observations of an object (there must be one), moved to the pose of a
// frame and clipped to the image, px. All its corners get one inverse depth (1 / m): from the depth
// points, or from the landmarks on the object, or from the point where the rays of the observations
// meet. If none of them is known, there is one hull for each of several inverse depths. A hull is
// empty if it is not in front of the camera.
std::vector<std::vector<Eigen::Vector2d>> CarryHull(
    const Sensor& sensor, std::span<const ResolvedObservation> observations,
    const Rigid3& cam_from_world);

}  // namespace hullslam
