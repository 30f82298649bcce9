// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/objects/object_options.h"
#include "objects/resolved_observation.h"

namespace hullslam {

struct Refinement {
  Ellipsoid ellipsoid;
  double cost = 0.0;       // half the sum of squares, robust
  bool is_usable = false;  // false if the solver failed; then the ellipsoid is the given one
};

// Returns the ellipsoid that best fits the observations. The solver begins with `ellipsoid`; poses
// are fixed. The lines of the detections constrain the ellipsoid, and depth points constrain its
// surface. A prior about `start` is needed because observations from similar directions do not
// determine the extent along the viewing direction. The better an object fits an ellipsoid, the
// more precise its lines are. The misfit measures this, so it sets the sigma of the lines:
// `misfit_px`, clamped to the bounds of the options.
Refinement RefineEllipsoid(const Ellipsoid& ellipsoid, const Ellipsoid& start, const Sensor& sensor,
                           std::span<const ResolvedObservation> observations, double misfit_px,
                           const ObjectRefinementOptions& options);

}  // namespace hullslam
