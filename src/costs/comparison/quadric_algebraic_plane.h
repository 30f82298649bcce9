// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "costs/quadric_in_camera.h"
#include "costs/residual_kind.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/line2.h"

namespace hullslam {

// A line of a silhouette as the plane pi = P^T l through the camera's centre and the line, scaled
// to a unit normal. In the camera frame pi = (n, 0) with n along K^T l.
class LinePlane {
 public:
  LinePlane(const PinholeCamera& camera, const SilhouetteLine& line);

  // pi^T Q* pi, m^2, and its derivative. With B = QuadricInCamera::square() it is h^2 - d^2, where
  // h^2 = n^T B n is the squared half extent of the ellipsoid along n and d = n.t the signed
  // distance of its centre from the plane. It is positive if the plane cuts the ellipsoid, and zero
  // if the plane touches it from either side. For a one-sided line it is also zero if the ellipsoid
  // reaches the plane or lies beyond it.
  double Value(const QuadricInCamera& quadric) const;
  ByObjectInCamera Derivative(const QuadricInCamera& quadric) const;

 private:
  bool IsMet(double value, double distance) const;

  Eigen::Vector3d normal_;  // camera frame
  bool is_one_sided_;
};

std::vector<LinePlane> PlanesOf(const PinholeCamera& camera, std::span<const SilhouetteLine> lines);

// `algebraic_plane` (Yu et al. 2025, Eq. 8): one residual per line, pi^T Q* pi / sigma, with sigma
// in m^2. It is h^2 - d^2 of LinePlane and therefore depends on the scale of the world: see
// RelativePlaneCost, which does not. Parameters as in QuadricInCamera. Not defined unless the
// quadric is in front of the camera.
class AlgebraicPlaneCost final : public ObjectCost {
 public:
  AlgebraicPlaneCost(const PinholeCamera& camera, std::span<const SilhouetteLine> lines,
                     double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  std::vector<LinePlane> planes_;
  double inverse_sigma_;
};

extern const ResidualKind kAlgebraicPlaneResidual;

}  // namespace hullslam
