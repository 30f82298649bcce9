// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hullslam {

// At most `count` of the elements, evenly chosen, the first one among them.
template <typename T>
std::vector<T> Thin(const std::vector<T>& all, size_t count) {
  count = std::min(count, all.size());
  std::vector<T> thinned;
  thinned.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    thinned.push_back(all[i * all.size() / count]);
  }
  return thinned;
}

}  // namespace hullslam
