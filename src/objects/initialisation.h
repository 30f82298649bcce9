// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_view.h"

namespace hullslam {

// Ellipsoids to refine from, made of depth points (m, world): oriented bounding boxes of the points
// between the 3rd and 97th percentile along each axis, times `inflation`; one along the principal
// axes and one of least volume (CGAL). Nothing for fewer than 20 points.
std::vector<Ellipsoid> StartsFromPoints(std::span<const Eigen::Vector3d> points, double inflation);

// A sphere where the rays through the middles of the boxes meet best, of their size; for objects
// without depth. Nothing where the rays do not meet in front of all cameras.
std::optional<Ellipsoid> StartFromRays(const PinholeCamera& camera,
                                       std::span<const ObjectView> views);

}  // namespace hullslam
