// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polyline.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace hullslam {
namespace {

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
