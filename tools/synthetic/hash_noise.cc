// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/hash_noise.h"

#include <cmath>

namespace hullslam::synthetic {
namespace {

// Inverse of the normal distribution function by bisection, precise enough for a float.
double NormalQuantile(double probability) {
  double low = -8.0;
  double high = 8.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

NormalTable::NormalTable() {
  for (size_t i = 0; i < quantiles_.size(); ++i) {
    const double probability =
        (static_cast<double>(i) + 0.5) / static_cast<double>(quantiles_.size());
    quantiles_[i] = static_cast<float>(NormalQuantile(probability));
  }
}

}  // namespace hullslam::synthetic
