// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace hullslam {

// Statistics of a list of errors, in the unit of the errors; all zero for an empty list.
struct ErrorStatistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  // for an even count the mean of the two middle errors
  double max = 0.0;
};

ErrorStatistics SummarizeErrors(std::vector<double> errors);

}  // namespace hullslam
