// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hullslam {

// Positions in the two lists that were paired.
struct IndexPair {
  size_t first = 0;
  size_t second = 0;
  friend bool operator==(const IndexPair&, const IndexPair&) = default;
};

// Pairs time stamps (seconds, both lists in ascending order) one to one by the rule of TUM's
// associate.py: of all pairs with |first - second| < max_difference the closest is taken, then the
// closest of what is left, and so on. The result is ordered by `first`.
std::vector<IndexPair> PairStampsGreedily(std::span<const double> first,
                                          std::span<const double> second, double max_difference);

// Position of the stamp nearest to `stamp`, the earlier one of two as near. `stamps` is ascending
// and not empty.
size_t NearestStamp(std::span<const double> stamps, double stamp);

// Smallest |first - second| over both ascending lists; infinite where one is empty.
double SmallestGap(std::span<const double> first, std::span<const double> second);

}  // namespace hullslam
