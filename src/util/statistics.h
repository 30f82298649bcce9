// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace hullslam {

// The median of at least one value. For an even number of values it is the larger of the two middle
// ones.
template <typename T>
T Median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The largest value that this share of at least one value reaches. For a half it is Median().
template <typename T>
T ReachedBy(double share, std::vector<T> values) {
  const auto below = static_cast<size_t>((1.0 - share) * static_cast<double>(values.size()));
  const auto reached =
      values.begin() + static_cast<std::ptrdiff_t>(std::min(below, values.size() - 1));
  std::nth_element(values.begin(), reached, values.end());
  return *reached;
}

// 95 % quantile of the chi-square distribution with 1, 2 or 3 degrees of freedom. If a squared
// error, in units of squared standard deviations, is larger, it counts as an outlier. The degrees
// of freedom are the number of residuals that are squared and added.
constexpr double Chi2Bound(size_t degrees_of_freedom) {
  constexpr std::array<double, 3> kQuantiles = {3.841, 5.991, 7.815};
  return kQuantiles.at(degrees_of_freedom - 1);
}

}  // namespace hullslam
