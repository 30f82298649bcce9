// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "objects/resolved_observation.h"
#include "scene/scene.h"

namespace hullslam {

// The covariance of the centre and of the half axes of an ellipsoid that was fitted to the lines of
// the observations. `start` is the shape of its prior. Nothing if no line touches the ellipsoid in
// front of the camera.
//
// The errors of lines are not independent. Most of them come from the shape: a real object is no
// ellipsoid, and where it reaches beyond its ellipsoid, all lines of all observations that touch it
// there are wrong in the same way. A thousand observations from one side tell no more about this
// than ten do. So the deviation of the shape, as a function of the unit normal n of the tangent
// plane, is taken as a random field on the sphere. With the correlation c(n, m) = exp(-(angle
// between n and m)^2 / (2 w^2)), its covariance is
//   K(n, m) = e^2 (c(n, m) + c(n, -m)) + o^2 (c(n, m) - c(n, -m)).
// The first term is the even part of the deviation, which boxes and cylinders have; it moves no
// centre unless the object is seen from one side only. The second term is the odd part, such as a
// handle. The variances e^2 and o^2 come from the measured excess of the lines (misfit.h)
// on opposite sides of the object. The fit takes up a part of the deviation: an odd one moves the
// centre (three parameters), an even one changes size and rotation (six). So what is left is
// divided by fewer degrees of freedom than there are independent directions.
//
// With the gradient J_k of the excess of line k, its weight w_k in the fit and H = sum w_k J_k
// J_k^T
// + P (the information of the prior), the covariance of the nine parameters is
//   H^-1 (sum_kl w_k w_l K(n_k, n_l) J_k J_l^T + N + P) H^-1,
// where N is what the noise of the masks adds. That noise is the scatter of lines that touch the
// object at nearly the same normal. The error of the camera's poses is not part of it.
//
// An axis is round if the turn about it has a sigma of more than 26 degrees, which a turn has that
// is anywhere in a quarter of a circle (90 / sqrt(12)), and the two half axes across differ by at
// most a fifth, so that a turn moves no line by more than a tenth of them. It is undetermined if
// its half axis has a sigma of more than a quarter of it, so that twice the size is within four
// sigmas. A parameter is also free if the prior tells more of it than all lines: (H^-1)_ii P_ii >
// 1/2.
std::optional<ShapeCovariance> CovarianceOf(const PinholeCamera& camera, const Ellipsoid& ellipsoid,
                                            const Ellipsoid& start,
                                            std::span<const ResolvedObservation> observations);

}  // namespace hullslam
