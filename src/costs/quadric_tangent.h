// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "costs/ellipse_projection.h"
#include "costs/residual_kind.h"
#include "hullslam/geometry/line2.h"

namespace hullslam {

// Signed distance, px, from a line of a silhouette to the tangent of the ellipse that is parallel
// to the line, on the side to which the line's normal points: n.m + c + sqrt(n^T S n). It is
// positive if the ellipse reaches beyond the line; for a one-sided line it is zero in this case.
double TangentDistance(const SilhouetteLine& line, const EllipseNumbers& ellipse);

// `tangent`: one residual per line, TangentDistance / sigma, with sigma in px. For the four sides
// of a box these are the errors of the four bounding-box coordinates, as in QuadricSLAM (Nicholson
// 2019). Parameters as in QuadricInCamera. Not defined unless the quadric is in front of the
// camera.
class TangentCost final : public ObjectCost {
 public:
  TangentCost(const PinholeCamera& camera, std::span<const SilhouetteLine> lines, double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PinholeCamera camera_;
  std::vector<SilhouetteLine> lines_;
  double inverse_sigma_;
};

extern const ResidualKind kTangentResidual;

}  // namespace hullslam
