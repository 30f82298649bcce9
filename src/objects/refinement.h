// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/objects/object_view.h"

namespace hullslam {

struct Refinement {
  Ellipsoid ellipsoid;
  double cost = 0.0;       // half the sum of squares, robust
  bool is_usable = false;  // false where the solver failed: the ellipsoid is the one given
};

// The ellipsoid that best explains the views, from `ellipsoid`; poses are fixed. Besides the
// residuals of the outlines (ObjectOptions::residual, with `sigma_px` a line) depth points pull at
// the surface and a prior at `start`: silhouettes over a small angle leave the extent along the
// view free.
Refinement RefineEllipsoid(const Ellipsoid& ellipsoid, const Ellipsoid& start, const Sensor& sensor,
                           std::span<const ObjectView> views, double sigma_px,
                           const ObjectOptions& options);

}  // namespace hullslam
