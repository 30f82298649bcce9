// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "costs/residual_kind.h"

namespace hullslam {

// `filtered_point` (QISO-SLAM, Wang et al. 2023): AlgebraicPointCost with those contour points that
// pass the chi-square test of GateContour with the projected ellipse at the start of the
// optimisation. If fewer than half of the points pass, this ellipse cannot judge the contour, and
// all points are used.
extern const ResidualKind kFilteredPointResidual;

}  // namespace hullslam
