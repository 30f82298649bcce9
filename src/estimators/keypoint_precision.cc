// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/keypoint_precision.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "util/statistics.h"

namespace hullslam::internal {
namespace {

constexpr double kMedianChi2 = 1.386;  // median for two degrees of freedom: 2 ln 2
constexpr double kMaxFactor = 2.0;     // largest factor on OutlierBound
constexpr double kMaxPrecision = 5.0;
constexpr size_t kMinErrors = 100;  // least number of errors for a reliable median

}  // namespace

double MeasureKeypointPrecision(std::vector<double> chi2, size_t points, double precision) {
  if (chi2.size() < kMinErrors) {
    return precision;
  }
  const double equations = 2.0 * static_cast<double>(chi2.size());
  const double free_share = std::max(0.3, 1.0 - 3.0 * static_cast<double>(points) / equations);
  const double sigma = std::sqrt(Median(std::move(chi2)) / (kMedianChi2 * free_share)) / precision;
  return std::clamp(1.0 / sigma, 1.0, kMaxPrecision);
}

double OutlierBoundFactor(double precision) { return std::min(kMaxFactor, precision * precision); }

}  // namespace hullslam::internal
