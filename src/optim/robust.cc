// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/robust.h"

#include <cmath>

namespace hullslam {

double HuberCost(double chi2, double bound) {
  return chi2 <= bound ? chi2 : 2.0 * std::sqrt(bound * chi2) - bound;
}

double HuberWeight(double chi2, double bound) {
  return chi2 <= bound ? 1.0 : std::sqrt(bound / chi2);
}

}  // namespace hullslam
