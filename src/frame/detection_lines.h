// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "frame/detection_outline.h"
#include "hullslam/frame/detection_options.h"
#include "hullslam/frame/instance_mask.h"
#include "hullslam/geometry/conic.h"
#include "hullslam/geometry/line2.h"

namespace hullslam {

// A line with the places of the outline (undistorted px) that say whether it is a silhouette.
struct LineOnOutline {
  Line2 line;
  Polygon2 touching;  // what it rests on: it is cut by the border where all of this is
  Polygon2 near;      // points of the boundary along it, to look for something nearer beyond
};

// The lines of a primitive, none shorter than `min_line_px` where they are edges; `ellipse` is for
// `conic`, which has none without. In the order of their angle for support lines.
std::vector<LineOnOutline> LinesOfOutline(const Outline& outline,
                                          const std::optional<Ellipse>& ellipse,
                                          ObjectPrimitive primitive,
                                          const DetectionOptions& options);

// The four sides of a raw box, each as the line through its undistorted quarter points.
std::vector<LineOnOutline> SidesOfBox(const Polygon2& raw_corners, const PinholeCamera& camera);

}  // namespace hullslam
