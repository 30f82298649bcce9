// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/objects/object_view.h"

namespace hullslam {

struct Refinement {
  Ellipsoid ellipsoid;
  double cost = 0.0;       // half the sum of squares, robust
  bool is_usable = false;  // false where the solver failed: the ellipsoid is the one given
};

// The ellipsoid that best explains the views, from `ellipsoid`; poses are fixed. Besides the
// outlines, depth points constrain the surface, and a prior about `start` constrains the shape:
// outlines over a small angle leave the extent along the view free. The better an object fits an
// ellipsoid, the more precise its outline is, so `misfit_px`, within the bounds of the options, is
// the sigma.
Refinement RefineEllipsoid(const Ellipsoid& ellipsoid, const Ellipsoid& start, const Sensor& sensor,
                           std::span<const ObjectView> views, double misfit_px,
                           const ObjectRefinementOptions& options);

}  // namespace hullslam
