// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hullslam {

// Minimum-cost assignment (Kuhn 1955; shortest augmenting paths): for each row the column it gets,
// -1 for none. A pair whose cost is not below `max_cost` is never made; leaving a row out costs
// `max_cost`. Of equal solutions always the same one is given.
std::vector<int> AssignMinimumCost(const Eigen::MatrixXd& cost, double max_cost);

}  // namespace hullslam
