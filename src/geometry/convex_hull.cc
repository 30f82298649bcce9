// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/convex_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/ch_bykat.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalPoints = std::vector<Kernel::Point_2>;

// The kernel with a fast test for the point farthest from a line. The test only decides where
// QuickHull splits, so it need not be exact. The kernel's own test uses interval arithmetic and
// takes most of the time of a hull.
struct Traits : Kernel {
  struct Less_signed_distance_to_line_2 {  // NOLINT(readability-identifier-naming): CGAL's name
    bool operator()(const Point_2& from, const Point_2& to, const Point_2& a,
                    const Point_2& b) const {
      return Side(from, to, a) < Side(from, to, b);
    }
    static double Side(const Point_2& from, const Point_2& to, const Point_2& p) {
      return (to.x() - from.x()) * (p.y() - from.y()) - (to.y() - from.y()) * (p.x() - from.x());
    }
  };
  // NOLINTNEXTLINE(readability-identifier-naming): CGAL's name
  Less_signed_distance_to_line_2 less_signed_distance_to_line_2_object() const { return {}; }
};

// Among equally distant points QuickHull may split at any, so some corners lie on the line between
// their neighbours or, by rounding, behind it. These corners are removed.
CgalPoints WithoutFlatCorners(const CgalPoints& corners) {
  const size_t size = corners.size();
  CgalPoints strict;
  strict.reserve(size);
  for (size_t i = 0; i < size; ++i) {
    const Kernel::Point_2& before = corners[(i + size - 1) % size];
    if (CGAL::left_turn(before, corners[i], corners[(i + 1) % size])) {
      strict.push_back(corners[i]);
    }
  }
  return strict;
}

// Removes corners until all are strict left turns by exact predicates. A true corner of the hull is
// a left turn whatever its neighbours are, so no true corner is removed.
CgalPoints StrictlyConvex(CgalPoints corners) {
  size_t before = 0;
  while (corners.size() >= 3 && corners.size() != before) {
    before = corners.size();
    corners = WithoutFlatCorners(corners);
  }
  return corners;
}

}  // namespace

std::vector<Eigen::Vector2d> ConvexHull(std::span<const Eigen::Vector2d> points) {
  CgalPoints input;
  input.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    Check(point.allFinite(), "the points of a hull are not finite");
    input.emplace_back(point.x(), point.y());
  }
  CgalPoints corners;
  CGAL::ch_bykat(input.begin(), input.end(), std::back_inserter(corners), Traits());
  corners = StrictlyConvex(std::move(corners));
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::vector<Eigen::Vector2d> hull;
  hull.reserve(corners.size());
  for (const Kernel::Point_2& corner : corners) {
    hull.emplace_back(corner.x(), corner.y());
  }
  return hull;
}

}  // namespace hullslam
