// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace hullslam {

// Huber's loss of a squared error, linear in the error beyond `bound` (both in squared sigmas):
// chi2 below the bound, 2 sqrt(bound chi2) - bound above.
inline double HuberCost(double chi2, double bound) {
  return chi2 <= bound ? chi2 : 2.0 * std::sqrt(bound * chi2) - bound;
}

// Weight of a squared error under HuberCost, which is its derivative: 1 below the bound,
// sqrt(bound / chi2) above.
inline double HuberWeight(double chi2, double bound) {
  return chi2 <= bound ? 1.0 : std::sqrt(bound / chi2);
}

}  // namespace hullslam
