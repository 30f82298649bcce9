// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
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

}  // namespace hullslam
