// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// Huber's loss of a squared error, linear in the error beyond `bound` (both in squared sigmas):
// chi2 below the bound, 2 sqrt(bound chi2) - bound above.
double HuberCost(double chi2, double bound);

// Weight of a squared error under HuberCost, which is its derivative: 1 below the bound,
// sqrt(bound / chi2) above.
double HuberWeight(double chi2, double bound);

}  // namespace hullslam
