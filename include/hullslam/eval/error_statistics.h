// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace hullslam {

// Of a list of errors, in their unit; zeros for an empty list.
struct ErrorStatistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  // mean of the two in the middle for an even count
  double max = 0.0;
};

ErrorStatistics SummarizeErrors(std::vector<double> errors);

}  // namespace hullslam
