// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "frame/detection/mask_camera.h"
#include "hullslam/frame/detection_options.h"
#include "hullslam/frame/instance_mask.h"
#include "hullslam/geometry/conic.h"
#include "hullslam/geometry/line2.h"

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

// A line with those points of the mask's outline (undistorted, px) that decide whether it is
// one-sided.
struct LineOnOutline {
  Line2 line;
  Polygon2 touching;  // points on the line; it is one-sided if the image border cuts all of them
  Polygon2 near;  // points along the line, where IsHidden() looks for something nearer beyond it
};

// The lines of a primitive. Edges shorter than `min_line_px` give no line. Support lines are in the
// order of their angle. `ellipse` is only used for `conic` and `box_ellipse`, which give no lines
// without it.
std::vector<LineOnOutline> LinesOfOutline(const Outline& outline,
                                          const std::optional<Ellipse>& ellipse,
                                          ObjectPrimitive primitive,
                                          const DetectionOptions& options);

// The four sides of a raw box, each as the line through its undistorted quarter points.
std::vector<LineOnOutline> SidesOfBox(const Polygon2& raw_corners, const MaskCamera& camera);

}  // namespace hullslam
