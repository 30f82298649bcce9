// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "hullslam/camera/pinhole.h"
#include "hullslam/costs/object_residual.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The approximate size of a residual, in its own unit, when the whole measured silhouette is
// `error_px` outside of the true one. As the sigma of a residual whose silhouette has a sigma of
// `error_px`, it gives all kinds of residuals the same weight. Let r be the radius of the circle
// that has the area of the projected ellipse, z the depth of the ellipsoid's centre and f the focal
// length:
//   tangent          error_px
//   algebraic_plane  2 h e with h = r z / f and e = error_px z / f
//   relative_plane   2 r error_px / f^2, which is algebraic_plane divided by z^2
//   algebraic_point  2 error_px / r
//   distribution     error_px^2 (Wasserstein, for an ellipse that is shifted by error_px)
//   overlap          1 - (r / (r + error_px))^2
//   bhattacharyya    error_px^2 / (8 r^2) (for an ellipse that is shifted by error_px)
//   box_bounds       error_px
//   filtered_point   2 error_px / r
// Nothing if the ellipsoid is not in front of the camera or its projected ellipse has no area.
std::optional<double> ResidualOfPixelError(ObjectResidual residual, const PinholeCamera& camera,
                                           const Rigid3& cam_from_world, const Ellipsoid& ellipsoid,
                                           double error_px);

}  // namespace hullslam
