// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "costs/ellipse_projection.h"
#include "costs/residual_kind.h"

namespace hullslam {

enum class DistributionDistance { kWasserstein, kBhattacharyya };

// `distribution`: one residual, the distance between the projected ellipse and a measured ellipse,
// divided by sigma. Each ellipse stands for a Gaussian with its centre as mean and its shape as
// covariance (m1, S1 and m2, S2). The distance is one of:
//   Wasserstein, squared, px^2 (Cao 2022; OA-SLAM, VOOM):
//     |m1 - m2|^2 + tr(S1 + S2 - 2 (S1^1/2 S2 S1^1/2)^1/2)
//   Bhattacharyya, without unit, with S = (S1 + S2) / 2:
//     (m1 - m2)^T S^-1 (m1 - m2) / 8 + ln(det S / sqrt(det S1 det S2)) / 2
// Parameters as in QuadricInCamera. Not defined unless the quadric is in front of the camera
// and its projected ellipse has an area.
class DistributionCost final : public EllipseCost {
 public:
  DistributionCost(const PinholeCamera& camera, const Ellipse& measured, double sigma,
                   DistributionDistance distance = DistributionDistance::kWasserstein);

 private:
  void Compute(const EllipseNumbers& ellipse, std::span<double> residuals,
               std::span<ByEllipse> by_ellipse) const override;

  Ellipse measured_;
  DistributionDistance distance_;
};

// The squared Wasserstein distance, px^2.
double SquaredWasserstein(const Ellipse& a, const Ellipse& b);

extern const ResidualKind kDistributionResidual;

// `bhattacharyya`: one residual, the Bhattacharyya distance of the projected ellipse and the
// measured one as Gaussians, without unit (DistributionCost with
// DistributionDistance::kBhattacharyya; OA-SLAM and VOOM refine their quadrics with it). Other than
// the Wasserstein distance it is a share of the size of the ellipses, so near and far objects have
// the same weight.
extern const ResidualKind kBhattacharyyaResidual;

}  // namespace hullslam
