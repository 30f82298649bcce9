// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/bow/bow_vector.h"

#include <algorithm>

namespace hullslam {

double Score(const BowVector& v, const BowVector& w) {
  double score = 0.0;
  for (auto a = v.begin(), b = w.begin(); a != v.end() && b != w.end();) {
    if (a->word < b->word) {
      ++a;
    } else if (b->word < a->word) {
      ++b;
    } else {
      score += static_cast<double>(std::min(a->weight, b->weight));
      ++a;
      ++b;
    }
  }
  return score;
}

}  // namespace hullslam
