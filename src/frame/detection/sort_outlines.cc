// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/sort_outlines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/polyline.h"

namespace hullslam {

void SortByArea(std::vector<std::vector<Eigen::Vector2d>>& outlines) {
  std::vector<std::pair<double, size_t>> areas;
  for (size_t i = 0; i < outlines.size(); ++i) {
    areas.emplace_back(-std::abs(SignedArea(outlines[i])),
                       i);  // the largest first; ties in the original order
  }
  std::sort(areas.begin(), areas.end());
  std::vector<std::vector<Eigen::Vector2d>> sorted;
  for (const auto& [negative_area, i] : areas) {
    if (-negative_area >= kSmallestOutlineArea) {
      sorted.push_back(std::move(outlines[i]));
    }
  }
  outlines = std::move(sorted);
}

}  // namespace hullslam
