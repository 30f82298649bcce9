// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// Weight of a squared error under Huber's loss that turns linear at `bound` (both in squared
// sigmas): 1 below the bound, sqrt(bound / chi2) above.
double HuberWeight(double chi2, double bound);

}  // namespace hullslam
