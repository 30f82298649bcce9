// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/typical_descriptor.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "util/function_clones.h"

namespace hullslam {
namespace {

HULLSLAM_FUNCTION_CLONES
size_t MostTypical(std::span<const Descriptor> descriptors) {
  const size_t n = descriptors.size();
  std::vector<int> distances(n * n, 0);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = i + 1; j < n; ++j) {
      const int distance = HammingDistance(descriptors[i], descriptors[j]);
      distances[i * n + j] = distance;
      distances[j * n + i] = distance;
    }
  }
  size_t best = 0;
  int best_median = std::numeric_limits<int>::max();
  for (size_t i = 0; i < n; ++i) {
    const auto row = distances.begin() + static_cast<std::ptrdiff_t>(i * n);
    const auto middle = row + static_cast<std::ptrdiff_t>((n - 1) / 2);
    std::nth_element(row, middle, row + static_cast<std::ptrdiff_t>(n));
    if (*middle < best_median) {
      best_median = *middle;
      best = i;
    }
  }
  return best;
}

}  // namespace

size_t MostTypicalDescriptor(std::span<const Descriptor> descriptors) {
  return MostTypical(descriptors);
}

}  // namespace hullslam
