// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polygon_overlap.h"

#include <algorithm>
#include <utility>

#include "geometry/polyline.h"

namespace hullslam {
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

}  // namespace hullslam
