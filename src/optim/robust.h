// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// 95 % quantiles of the chi-square distribution with two (pixel) and three (pixel and virtual right
// coordinate) degrees of freedom: errors above are outliers.
inline constexpr double kChi2Mono = 5.991;
inline constexpr double kChi2Rgbd = 7.815;

// Weight of a squared error under Huber's loss that turns linear at `bound` (both in squared
// sigmas): 1 below the bound, sqrt(bound / chi2) above.
double HuberWeight(double chi2, double bound);

}  // namespace hullslam
