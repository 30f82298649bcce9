// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "hullslam/camera/pinhole.h"
#include "hullslam/costs/object_residual.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// About how large a residual of a detection is when its outline is `error_px` outside of the true
// one everywhere, in the residual's unit: its sigma for an outline with a sigma of `error_px`, so
// that all kinds of residuals weigh alike. With r the radius of the circle of the outline's area:
//   tangent          error_px
//   algebraic_plane  2 h e with h = r z / f and e = error_px z / f
//   algebraic_point  2 error_px / r
//   distribution     error_px^2 (Wasserstein, of an outline shifted by error_px)
//   overlap          1 - (r / (r + error_px))^2
// Nothing where the ellipsoid is not in front of the camera or its outline has no area.
std::optional<double> ResidualOfPixelError(ObjectResidual residual, const PinholeCamera& camera,
                                           const Rigid3& cam_from_world, const Ellipsoid& ellipsoid,
                                           double error_px);

}  // namespace hullslam
