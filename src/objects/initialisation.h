// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/objects/object_view.h"

namespace hullslam {

// Ellipsoids to refine from, made of depth points (world) at this distance from the cameras:
// oriented bounding boxes of the points without those trimmed at the ends, inflated. One box lies
// along the principal axes, one is that of least volume (CGAL). Empty for fewer than
// kMinDepthPoints.
std::vector<Ellipsoid> StartsFromPoints(std::span<const Eigen::Vector3d> points, double distance,
                                        const StartOptions& options);

// A sphere where the rays through the centres of the boxes meet best, of their mean size; for
// objects without depth. Nothing where the rays do not meet in front of all cameras.
std::optional<Ellipsoid> StartFromRays(const PinholeCamera& camera,
                                       std::span<const ObjectView> views,
                                       const StartOptions& options);

}  // namespace hullslam
