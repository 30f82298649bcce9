// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/error_statistics.h"

#include <algorithm>
#include <cmath>

namespace hullslam {

ErrorStatistics SummarizeErrors(std::vector<double> errors) {
  ErrorStatistics statistics;
  if (errors.empty()) {
    return statistics;
  }
  std::sort(errors.begin(), errors.end());
  double sum = 0.0;
  double squares = 0.0;
  for (const double error : errors) {
    sum += error;
    squares += error * error;
  }
  const size_t count = errors.size();
  statistics.rmse = std::sqrt(squares / static_cast<double>(count));
  statistics.mean = sum / static_cast<double>(count);
  statistics.median = 0.5 * (errors[(count - 1) / 2] + errors[count / 2]);
  statistics.max = errors.back();
  return statistics;
}

}  // namespace hullslam
