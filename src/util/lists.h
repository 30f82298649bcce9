// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hullslam {

// At most `count` of the elements, evenly chosen, including the first one.
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

// Every k-th element, beginning with the first, with the least k for which at most `count` remain.
template <typename T>
std::vector<T> EveryKth(const std::vector<T>& all, size_t count) {
  std::vector<T> thinned;
  if (count == 0) {
    return thinned;
  }
  const size_t step = std::max<size_t>(1, (all.size() + count - 1) / count);
  for (size_t i = 0; i < all.size(); i += step) {
    thinned.push_back(all[i]);
  }
  return thinned;
}

// Sorts the values and leaves each of them once.
template <typename Value>
void SortUnique(std::vector<Value>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace hullslam
