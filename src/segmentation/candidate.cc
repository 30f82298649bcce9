// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/candidate.h"

#include <algorithm>
#include <utility>

namespace hullslam {
namespace {

double Overlap(const Candidate& a, const Candidate& b) {
  const Eigen::Array2d common = (a.greatest.min(b.greatest) - a.least.max(b.least)).max(0.0);
  const double both = common.prod();
  const double together = (a.greatest - a.least).prod() + (b.greatest - b.least).prod() - both;
  return together > 0.0 ? both / together : 0.0;
}

}  // namespace

std::vector<Candidate> SuppressOverlaps(std::vector<Candidate> candidates) {
  std::ranges::stable_sort(candidates, std::ranges::greater(), &Candidate::score);
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    const bool is_same = std::ranges::any_of(kept, [&](const Candidate& better) {
      return better.class_number == candidate.class_number &&
             Overlap(better, candidate) > kMostOverlap;
    });
    if (!is_same) {
      kept.push_back(std::move(candidate));
    }
    if (kept.size() == kMostInstances) {
      break;
    }
  }
  return kept;
}

}  // namespace hullslam
