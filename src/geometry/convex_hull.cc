// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/convex_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/ch_bykat.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Points = std::vector<Kernel::Point_2>;

// CGAL 5.5 keeps some collinear corners: of equally distant points it takes any to split at.
Points WithoutCollinear(const Points& corners) {
  const size_t size = corners.size();
  if (size < 3) {
    return corners;
  }
  Points strict;
  strict.reserve(size);
  for (size_t i = 0; i < size; ++i) {
    const Kernel::Point_2& before = corners[(i + size - 1) % size];
    if (CGAL::left_turn(before, corners[i], corners[(i + 1) % size])) {
      strict.push_back(corners[i]);
    }
  }
  return strict;
}

}  // namespace

std::vector<Eigen::Vector2d> ConvexHull(std::span<const Eigen::Vector2d> points) {
  Points input;
  input.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    Check(point.allFinite(), "a hull is taken of finite points");
    input.emplace_back(point.x(), point.y());
  }
  Points corners;
  CGAL::ch_bykat(input.begin(), input.end(), std::back_inserter(corners), Kernel());
  corners = WithoutCollinear(corners);
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::vector<Eigen::Vector2d> hull;
  hull.reserve(corners.size());
  for (const Kernel::Point_2& corner : corners) {
    hull.emplace_back(corner.x(), corner.y());
  }
  return hull;
}

}  // namespace hullslam
