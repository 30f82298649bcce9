// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/stamp_pairing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

struct Candidate {
  double difference = 0.0;
  IndexPair pair;
};

// The candidates of one stamp are neighbours in the other list, so one sweep finds them all.
std::vector<Candidate> FindCandidates(std::span<const double> first, std::span<const double> second,
                                      double max_difference) {
  std::vector<Candidate> candidates;
  size_t begin = 0;
  for (size_t i = 0; i < first.size(); ++i) {
    while (begin < second.size() && first[i] - second[begin] >= max_difference) {
      ++begin;
    }
    for (size_t j = begin; j < second.size() && second[j] - first[i] < max_difference; ++j) {
      candidates.push_back({std::abs(first[i] - second[j]), {i, j}});
    }
  }
  return candidates;
}

}  // namespace

std::vector<IndexPair> PairStampsGreedily(std::span<const double> first,
                                          std::span<const double> second, double max_difference) {
  std::vector<Candidate> candidates = FindCandidates(first, second, max_difference);
  // Ties are broken by time, as in the sorted tuples of associate.py.
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.difference, a.pair.first, a.pair.second) <
           std::tie(b.difference, b.pair.first, b.pair.second);
  });
  std::vector<bool> first_used(first.size());
  std::vector<bool> second_used(second.size());
  std::vector<IndexPair> pairs;
  for (const Candidate& candidate : candidates) {
    const auto [i, j] = candidate.pair;
    if (!first_used[i] && !second_used[j]) {
      first_used[i] = true;
      second_used[j] = true;
      pairs.push_back(candidate.pair);
    }
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const IndexPair& a, const IndexPair& b) { return a.first < b.first; });
  return pairs;
}

size_t NearestStamp(std::span<const double> stamps, double stamp) {
  Check(!stamps.empty(), "there is no nearest stamp in an empty list");
  const auto next = std::lower_bound(stamps.begin(), stamps.end(), stamp);
  if (next == stamps.begin()) {
    return 0;
  }
  const size_t after = next - stamps.begin();
  if (next == stamps.end() || stamp - stamps[after - 1] <= *next - stamp) {
    return after - 1;
  }
  return after;
}

double SmallestGap(std::span<const double> first, std::span<const double> second) {
  double smallest = std::numeric_limits<double>::infinity();
  if (!second.empty()) {
    for (const double stamp : first) {
      smallest = std::min(smallest, std::abs(second[NearestStamp(second, stamp)] - stamp));
    }
  }
  return smallest;
}

}  // namespace hullslam
