// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// The landmarks of a map whose distance is known.
struct LocatedLandmarks {
  std::vector<Eigen::Vector3d> positions;  // m, world frame, by increasing id
  std::vector<LandmarkId> ids;             // one per position
  size_t at_infinity = 0;                  // number of the other landmarks
};

// Whether the observations of a landmark tell it from a point at infinity; see LocateLandmarks().
bool IsDistanceKnown(const Map& map, const Landmark& landmark, const Sensor& sensor);

// Finds the landmarks that their observations tell from points at infinity. If a landmark is at the
// distance d from a camera, and s is the standard deviation of d, then the inverse distance 1 / d
// has the standard deviation s / d^2. It differs from 0 by two standard deviations if d >= 2 s. The
// landmarks for which this does not hold constrain rotations like all others, but their positions
// mean nothing.
LocatedLandmarks LocateLandmarks(const Map& map, const Sensor& sensor);

}  // namespace hullslam
