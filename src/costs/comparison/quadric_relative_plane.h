// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "costs/comparison/quadric_algebraic_plane.h"
#include "costs/quadric_in_camera.h"
#include "costs/residual_kind.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/line2.h"

namespace hullslam {

// `relative_plane`: one residual per line, the residual of `algebraic_plane` relative to the depth
// of the object, pi^T Q* pi / z^2 / sigma, where z is the depth of the ellipsoid's centre in the
// camera. It has no unit, nor has sigma.
//
// Why it is divided. Let the whole world (cameras, landmarks, objects) be s times as large. Then
// the centre of the ellipsoid in the camera frame is s t and its half axes are s times as long, so
// B becomes s^2 B, and with the unit normal n of the plane
//   pi^T Q* pi = n^T B n - (n.t)^2   becomes   s^2 (n^T B n - (n.t)^2).
// The images do not change, so the reprojection errors of landmarks do not change either. But the
// cost E = 1/2 sum (pi^T Q* pi / sigma)^2, with a sigma in m^2 that is fixed during an
// optimisation, becomes s^4 E. Its derivative with respect to log s is 4 E, which is positive as
// long as one line does not fit. So every optimisation of `algebraic_plane` that moves cameras also
// shrinks the map, until something with a known length (depth, a fixed keyframe) resists. After the
// division
//   r = (n^T B n - (n.t)^2) / z^2
// numerator and denominator are both multiplied by s^2, so the cost does not depend on s. h / z and
// d / z are half extent and distance as they are seen from the camera, at depth 1.
//
// z is a variable of the optimisation, not a constant: with its value at the start, r would be the
// literal residual again. With dr = d(pi^T Q* pi) / z^2 - 2 r / z dz, only the derivative with
// respect to the shift along the optical axis gets a second term. At the start of an optimisation,
// all residuals and weights are as with `algebraic_plane` and the same error in pixels.
//
// Parameters as in QuadricInCamera. Not defined unless the quadric is in front of the camera.
class RelativePlaneCost final : public ObjectCost {
 public:
  RelativePlaneCost(const PinholeCamera& camera, std::span<const SilhouetteLine> lines,
                    double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  std::vector<LinePlane> planes_;
  double inverse_sigma_;
};

extern const ResidualKind kRelativePlaneResidual;

}  // namespace hullslam
