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

// Cauchy's loss of a squared error, logarithmic in errors beyond `scale` (scale in sigmas, chi2 in
// squared sigmas). Unlike under Huber's loss, the gradient falls again for large errors.
inline double CauchyCost(double chi2, double scale) {
  return scale * scale * std::log1p(chi2 / (scale * scale));
}

// Weight of a squared error under CauchyCost, which is its derivative.
inline double CauchyWeight(double chi2, double scale) {
  return 1.0 / (1.0 + chi2 / (scale * scale));
}

// The losses of reprojection errors in bundle adjustment: Huber's with the bound OutlierBound,
// Cauchy's with the scale kCauchyScale, or none.
enum class PointLoss { kNone, kHuber, kCauchy };

inline constexpr double kCauchyScale = 4.0;  // sigmas

}  // namespace hullslam
