// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hullslam {

// Minimum-cost assignment, by Boost's maximum weighted matching (Galil 1986). Returns the column of
// each row, -1 for a row without a column. Leaving a row out costs `max_cost`; a pair whose cost is
// not below `max_cost` is never chosen. Costs are rounded to 1e-12 and at most a million less than
// `max_cost`. Among equal solutions the choice is deterministic.
std::vector<int> AssignMinimumCost(const Eigen::MatrixXd& cost, double max_cost);

}  // namespace hullslam
