// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "costs/residual_kind.h"

namespace hullslam {

// `bhattacharyya`: one residual, the Bhattacharyya distance of the projected ellipse and the
// measured one as Gaussians, without unit (DistributionCost with
// DistributionDistance::kBhattacharyya; OA-SLAM and VOOM refine their quadrics with it). Other than
// the Wasserstein distance it is a share of the size of the ellipses, so near and far objects have
// the same weight.
extern const ResidualKind kBhattacharyyaResidual;

}  // namespace hullslam
