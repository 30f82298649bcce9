// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace hullslam {

// 95 % quantile of the chi-square distribution with 1, 2 or 3 degrees of freedom. If a squared
// error, in units of squared standard deviations, is larger, it counts as an outlier. The degrees
// of freedom are the number of residuals that are squared and added.
constexpr double Chi2Bound(size_t degrees_of_freedom) {
  constexpr std::array<double, 3> kQuantiles = {3.841, 5.991, 7.815};
  return kQuantiles.at(degrees_of_freedom - 1);
}

}  // namespace hullslam
