// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "frame/detection/detection_outline.h"
#include "hullslam/frame/detection_options.h"
#include "hullslam/frame/instance_mask.h"
#include "hullslam/geometry/conic.h"
#include "hullslam/geometry/line2.h"

namespace hullslam {

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
