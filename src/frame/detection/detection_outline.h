// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "frame/detection/mask_camera.h"

namespace hullslam {

using Polygon2 = std::vector<Eigen::Vector2d>;

// The shape of a mask, undistorted, px. The polygons are closed and have positive signed area.
struct Outline {
  Polygon2 contour;   // contour of the largest part; its points are a few pixels apart
  Polygon2 boundary;  // the points of the outlines of all parts
  Polygon2 hull;      // convex hull of all parts; fewer than three corners if they have no area
};

// The parts of a mask whose area is at least `min_share` of that of its largest part, in raw
// pixels. Parts without area are left out.
std::vector<Polygon2> LargeParts(std::span<const Polygon2> outlines, double min_share);

Outline UndistortOutline(std::span<const Polygon2> parts, const MaskCamera& camera);

}  // namespace hullslam
