// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/convex_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/ch_bykat.h>

#include <algorithm>
#include <iterator>

#include "hullslam/util/check.h"

namespace hullslam {

std::vector<Eigen::Vector2d> ConvexHull(std::span<const Eigen::Vector2d> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_2> input;
  input.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    Check(point.allFinite(), "a hull is taken of finite points");
    input.emplace_back(point.x(), point.y());
  }
  std::vector<Kernel::Point_2> corners;
  CGAL::ch_bykat(input.begin(), input.end(), std::back_inserter(corners), Kernel());
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::vector<Eigen::Vector2d> hull;
  hull.reserve(corners.size());
  for (const Kernel::Point_2& corner : corners) {
    hull.emplace_back(corner.x(), corner.y());
  }
  return hull;
}

}  // namespace hullslam
