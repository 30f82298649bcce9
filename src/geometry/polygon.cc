// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polygon.h"

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

double SquaredDistanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                                const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double length2 = along.squaredNorm();
  const double share =
      length2 > 0.0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - from - share * along).squaredNorm();
}

size_t Farthest(std::span<const Eigen::Vector2d> polygon, size_t from) {
  size_t farthest = from;
  double largest = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const double distance2 = (polygon[i] - polygon[from]).squaredNorm();
    if (distance2 > largest) {
      largest = distance2;
      farthest = i;
    }
  }
  return farthest;
}

// Marks the corners between `first` and `last` that are needed to stay within `epsilon`. `last` may
// exceed the number of corners: the polygon is closed, so indices wrap around.
void MarkChain(std::span<const Eigen::Vector2d> polygon, size_t first, size_t last, double epsilon,
               std::vector<bool>& kept) {
  const size_t size = polygon.size();
  std::vector<std::pair<size_t, size_t>> chains{{first, last}};
  while (!chains.empty()) {
    const auto [begin, end] = chains.back();
    chains.pop_back();
    double largest = epsilon * epsilon;
    size_t split = end;
    for (size_t i = begin + 1; i < end; ++i) {
      const double distance2 =
          SquaredDistanceToSegment(polygon[i % size], polygon[begin % size], polygon[end % size]);
      if (distance2 > largest) {
        largest = distance2;
        split = i;
      }
    }
    if (split != end) {
      kept[split % size] = true;
      chains.emplace_back(begin, split);
      chains.emplace_back(split, end);
    }
  }
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

namespace {

using Corners = std::vector<Eigen::Vector2d>;

// The part of a convex polygon where the linear function `side` is not negative (Sutherland and
// Hodgman 1974).
template <typename Side>
void ClipBySide(std::span<const Eigen::Vector2d> polygon, const Side& side, Corners& clipped) {
  clipped.clear();
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    const double side_a = side(a);
    const double side_b = side(b);
    if (side_a >= 0.0) {
      clipped.push_back(a);
    }
    if ((side_a > 0.0 && side_b < 0.0) || (side_a < 0.0 && side_b > 0.0)) {
      clipped.emplace_back(a + side_a / (side_a - side_b) * (b - a));
    }
  }
}

// The part to the left of the directed line through `from` and `to`. The left side of an edge is
// the inside of a polygon with positive area.
void ClipToLeft(std::span<const Eigen::Vector2d> polygon, const Eigen::Vector2d& from,
                const Eigen::Vector2d& to, Corners& clipped) {
  const Eigen::Vector2d along = to - from;
  ClipBySide(
      polygon,
      [&](const Eigen::Vector2d& p) {
        return along.x() * (p.y() - from.y()) - along.y() * (p.x() - from.x());
      },
      clipped);
}

Corners Clip(std::span<const Eigen::Vector2d> polygon, std::span<const Eigen::Vector2d> window) {
  if (polygon.size() < 3 || window.size() < 3 ||
      !BoundingBox(polygon).intersects(BoundingBox(window))) {
    return {};
  }
  Corners clipped(polygon.begin(), polygon.end());
  Corners next;
  for (size_t i = 0; i < window.size() && !clipped.empty(); ++i) {
    ClipToLeft(clipped, window[i], window[(i + 1) % window.size()], next);
    clipped.swap(next);
  }
  return clipped.size() < 3 ? Corners() : clipped;
}

double Ratio(double intersection, double area_a, double area_b) {
  const double total = area_a + area_b - intersection;
  return total > 0.0 ? std::clamp(intersection / total, 0.0, 1.0) : 0.0;
}

double Area(std::span<const Eigen::Vector2d> polygon) {
  return polygon.size() < 3 ? 0.0 : std::max(0.0, SignedArea(polygon));
}

double Area(const Eigen::AlignedBox2d& box) { return box.isEmpty() ? 0.0 : box.volume(); }

}  // namespace

std::vector<Eigen::Vector2d> ClipToBox(std::span<const Eigen::Vector2d> polygon,
                                       const Eigen::AlignedBox2d& box) {
  if (box.isEmpty()) {
    return {};
  }
  const Eigen::Vector2d& low = box.min();
  const Eigen::Vector2d& high = box.max();
  return Clip(polygon, Corners{low, {high.x(), low.y()}, high, {low.x(), high.y()}});
}

std::vector<Eigen::Vector2d> ClipToHalfPlane(std::span<const Eigen::Vector2d> polygon,
                                             const Eigen::Vector2d& normal, double offset) {
  Corners clipped;
  ClipBySide(
      polygon, [&](const Eigen::Vector2d& p) { return offset - normal.dot(p); }, clipped);
  return clipped;
}

double IntersectionArea(std::span<const Eigen::Vector2d> a, std::span<const Eigen::Vector2d> b) {
  return Area(Clip(a, b));
}

double IntersectionOverUnion(std::span<const Eigen::Vector2d> a,
                             std::span<const Eigen::Vector2d> b) {
  return Ratio(IntersectionArea(a, b), Area(a), Area(b));
}

double IntersectionOverUnion(const Eigen::AlignedBox2d& a, const Eigen::AlignedBox2d& b) {
  return Ratio(Area(a.intersection(b)), Area(a), Area(b));
}

std::vector<Eigen::Vector2d> SimplifyPolygon(std::span<const Eigen::Vector2d> polygon,
                                             double epsilon) {
  if (!(epsilon > 0.0) || polygon.size() < 3) {
    return {polygon.begin(), polygon.end()};
  }
  // The algorithm needs two end points. A closed polygon has none, so two corners that are far
  // apart are used.
  size_t first = Farthest(polygon, 0);
  size_t second = Farthest(polygon, first);
  if (first > second) {
    std::swap(first, second);
  }
  std::vector<bool> kept(polygon.size(), false);
  kept[first] = true;
  kept[second] = true;
  MarkChain(polygon, first, second, epsilon, kept);
  MarkChain(polygon, second, first + polygon.size(), epsilon, kept);
  std::vector<Eigen::Vector2d> simplified;
  for (size_t i = 0; i < polygon.size(); ++i) {
    if (kept[i]) {
      simplified.push_back(polygon[i]);
    }
  }
  return simplified;
}

double SignedArea(std::span<const Eigen::Vector2d> polygon) {
  double twice = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    // Coordinates relative to a corner avoid cancellation far from the origin.
    const Eigen::Vector2d a = polygon[i] - polygon[0];
    const Eigen::Vector2d b = polygon[(i + 1) % polygon.size()] - polygon[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

bool IsInOrNearConvex(std::span<const Eigen::Vector2d> polygon, const Eigen::Vector2d& point,
                      double margin) {
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Eigen::Vector2d offset = point - polygon[i];
    if (edge.x() * offset.y() - edge.y() * offset.x() < -margin * edge.norm()) {
      return false;
    }
  }
  return true;
}

Eigen::AlignedBox2d BoundingBox(std::span<const Eigen::Vector2d> points) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& point : points) {
    box.extend(point);
  }
  return box;
}

}  // namespace hullslam
