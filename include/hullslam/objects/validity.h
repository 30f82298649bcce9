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

// Why a quadric is not one of the object that these views show, with the figure that tells.
struct Objection {
  ObjectRejection reason = ObjectRejection::kFewViews;
  std::string detail;  // "mean IoU 0.31, expected at least 0.40"
};

// Checks, in this order: in front of every camera; half axes from 5 mm to 3 m (or a fifth of the
// distance, if that is more); mean IoU of outline and hull; and with depth: most points inside or
// near the surface, no half axis stretched beyond the points. Nothing for a valid one.
std::optional<Objection> FindObjection(const Ellipsoid& ellipsoid, const Sensor& sensor,
                                       std::span<const ObjectView> views,
                                       const ValidityOptions& options);

// Mean over the views of the IoU of the outline, clipped to the image, with the hull, or of their
// boxes where the mask is a box; 0 where the ellipsoid is not in front of a camera.
double MeanOverlap(const Ellipsoid& ellipsoid, const Sensor& sensor,
                   std::span<const ObjectView> views);

}  // namespace hullslam
