// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_options.h"
#include "objects/resolved_observation.h"

namespace hullslam {

// The ellipsoid with these axes (columns, right-handed) and the inflated box of the points, without
// the share that is trimmed at each end of each axis. `distance` as below. Needs a point.
Ellipsoid FitAlong(std::span<const Eigen::Vector3d> points, const Eigen::Matrix3d& axes,
                   double distance, const StartOptions& options);

// Starts for refinement, computed from depth points in the world frame. `distance` is the distance
// of the points from the cameras. A share of the points is left out at each end of each axis. The
// half axes are those of an oriented bounding box of the other points, times the inflation. One
// start uses the principal axes, the other one the box with the least volume (CGAL). Empty for
// fewer than kMinDepthPoints points.
std::vector<Ellipsoid> StartsFromPoints(std::span<const Eigen::Vector3d> points, double distance,
                                        const StartOptions& options);

// The start of an object without depth: a sphere at the point nearest to the rays through the
// centres of the bounding boxes, with the mean size of the boxes. Nothing if the rays are nearly
// parallel or do not meet in front of all cameras.
std::optional<Ellipsoid> StartFromRays(const PinholeCamera& camera,
                                       std::span<const ResolvedObservation> observations,
                                       const StartOptions& options);

// The start of an object without depth points whose landmarks have a known depth: a sphere with the
// mean size of the boxes, whose surface is at the depth of the landmarks. Nothing if fewer than
// half of the observations have such a depth or if the sphere is not in front of all cameras.
std::optional<Ellipsoid> StartFromLandmarks(const PinholeCamera& camera,
                                            std::span<const ResolvedObservation> observations,
                                            const StartOptions& options);

}  // namespace hullslam
