// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hullslam {

constexpr double kSmallestOutlineArea = 1.0;  // px^2

// Sorts outlines by area, the largest first, and removes those smaller than kSmallestOutlineArea.
void SortByArea(std::vector<std::vector<Eigen::Vector2d>>& outlines);

}  // namespace hullslam
