// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/objects/object_view.h"
#include "hullslam/objects/rejection.h"

namespace hullslam {

// Why a quadric cannot be that of the object which these views show, with the figure that says so.
struct Objection {
  ObjectRejection reason = ObjectRejection::kFewViews;
  std::string detail;  // "mean IoU 0.31, expected at least 0.40"
};

// How far outside of a quadric a point still counts as near it; `distance` is that of the quadric
// from the cameras.
double NearSurface(const Ellipsoid& ellipsoid, double distance, const ValidityOptions& options);

// Checks, in this order: in front of every camera; the range of the half axes; mean IoU of
// projected ellipse and hull; and with depth: enough points inside or near the surface, no half
// axis stretched far beyond the points. Nothing for a valid quadric. Needs one view at least.
std::optional<Objection> FindObjection(const Ellipsoid& ellipsoid, const Sensor& sensor,
                                       std::span<const ObjectView> views,
                                       const ValidityOptions& options);

// Mean over the views of the IoU of the projected ellipse, clipped to the image, with the hull, or
// of their boxes where the mask is a box; 0 where the ellipsoid is not in front of a camera.
double MeanOverlap(const Ellipsoid& ellipsoid, const Sensor& sensor,
                   std::span<const ObjectView> views);

}  // namespace hullslam
