// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "costs/ellipse_projection.h"
#include "hullslam/geometry/line2.h"

namespace hullslam {

// Signed distance, px, from a line of a silhouette to the tangent of the ellipse that is parallel
// to it and on the side its normal points to: n.m + c + sqrt(n^T S n). Positive where the ellipse
// reaches over the line. One-sided: zero there.
double TangentDistance(const SilhouetteLine& line, const EllipseNumbers& ellipse);

// `tangent`: one residual a line, TangentDistance / sigma, sigma in px. With the four sides of a
// box these are the four bounding-box coordinates of QuadricSLAM (Nicholson 2019). Parameters:
// those of QuadricInCamera. Not defined unless the quadric is in front of the camera.
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

}  // namespace hullslam
