// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hullslam {

// Indices of two paired entries, one per list.
struct IndexPair {
  size_t first = 0;
  size_t second = 0;
  friend bool operator==(const IndexPair&, const IndexPair&) = default;
};

// Pairs time stamps (seconds, both lists in ascending order) one to one by the rule of TUM's
// associate.py: the closest of all pairs with |first - second| < max_difference is taken first,
// then the closest of the remaining pairs, and so on. The result is ordered by `first`.
std::vector<IndexPair> PairStampsGreedily(std::span<const double> first,
                                          std::span<const double> second, double max_difference);

// Index of the stamp nearest to `stamp`; ties go to the earlier one. `stamps` is ascending and not
// empty.
size_t NearestStamp(std::span<const double> stamps, double stamp);

// Smallest |first - second| over both ascending lists; infinity if either is empty.
double SmallestGap(std::span<const double> first, std::span<const double> second);

}  // namespace hullslam
