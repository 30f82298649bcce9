// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

using Polygon2 = std::vector<Eigen::Vector2d>;

// What is seen of an object, undistorted; closed polygons of positive signed area.
struct Outline {
  Polygon2 contour;   // of the largest part; neighbouring points are a few pixels apart
  Polygon2 boundary;  // the points of the contours of all parts
  Polygon2 hull;      // of all parts; less than three corners where they have no area
};

// The parts of a mask whose area is at least this share of that of its largest part, raw; none
// without an area.
std::vector<Polygon2> LargeParts(std::span<const Polygon2> outlines, double min_share);

Outline UndistortOutline(std::span<const Polygon2> parts, const PinholeCamera& camera);

}  // namespace hullslam
