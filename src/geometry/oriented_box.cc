// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/oriented_box.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "geometry/polygon.h"

namespace hullslam {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

struct Hull {
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector3d> normals;  // normals of its sides, inwards or outwards
};

// CGAL gives the corners and sides in an order that depends on their addresses in memory. They are
// sorted, so that the same points always give the same numbers.
Hull HullOf(std::span<const Eigen::Vector3d> points) {
  std::vector<Kernel::Point_3> input;
  input.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    input.emplace_back(point.x(), point.y(), point.z());
  }
  Mesh mesh;
  CGAL::convex_hull_3(input.begin(), input.end(), mesh);

  std::vector<Kernel::Point_3> corners;
  for (const Mesh::Vertex_index corner : mesh.vertices()) {
    corners.push_back(mesh.point(corner));
  }
  std::sort(corners.begin(), corners.end());
  std::vector<std::array<Kernel::Point_3, 3>> sides;
  for (const Mesh::Face_index side : mesh.faces()) {
    const Mesh::Halfedge_index edge = mesh.halfedge(side);
    auto& triangle =
        sides.emplace_back(std::array{mesh.point(mesh.source(edge)), mesh.point(mesh.target(edge)),
                                      mesh.point(mesh.target(mesh.next(edge)))});
    std::sort(triangle.begin(), triangle.end());
  }
  std::sort(sides.begin(), sides.end());

  const auto to_eigen = [](const auto& v) { return Eigen::Vector3d(v.x(), v.y(), v.z()); };
  Hull hull;
  for (const Kernel::Point_3& corner : corners) {
    hull.corners.push_back(to_eigen(corner));
  }
  for (const auto& [a, b, c] : sides) {
    // If the points are nearly on a line, a side may have no area within double precision.
    const Eigen::Vector3d across = to_eigen(CGAL::cross_product(b - a, c - a));
    if (across.squaredNorm() > 0.0) {
      hull.normals.push_back(across.normalized());
    }
  }
  return hull;
}

template <typename Points, typename Direction>
double Extent(const Points& points, const Direction& direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const auto& point : points) {
    const double value = direction.dot(point);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return high - low;
}

struct Rectangle {
  double area = std::numeric_limits<double>::infinity();
  Eigen::Vector2d side = Eigen::Vector2d::UnitX();  // direction of one of its sides
};

// The smallest rectangle around a convex polygon. It has a side on one of the polygon's sides
// (Freeman and Shapira 1975).
Rectangle SmallestRectangle(const std::vector<Eigen::Vector2d>& polygon) {
  Rectangle best;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d side = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    const Eigen::Vector2d across(-side.y(), side.x());
    const double area = Extent(polygon, side) * Extent(polygon, across);
    if (area < best.area) {
      best = {area, side};
    }
  }
  return best;
}

}  // namespace

std::optional<Eigen::Matrix3d> OrientedBoxAxes(std::span<const Eigen::Vector3d> points) {
  if (points.size() < 4) {
    return std::nullopt;
  }
  const Hull hull = HullOf(points);
  double least = std::numeric_limits<double>::infinity();
  std::optional<Eigen::Matrix3d> best;
  std::vector<Eigen::Vector2d> seen(hull.corners.size());
  for (const Eigen::Vector3d& normal : hull.normals) {
    const Eigen::Vector3d right = normal.unitOrthogonal();
    const Eigen::Vector3d up = normal.cross(right);
    for (size_t i = 0; i < seen.size(); ++i) {
      seen[i] = {right.dot(hull.corners[i]), up.dot(hull.corners[i])};
    }
    const Rectangle rectangle = SmallestRectangle(ConvexHull(seen));
    const double volume = rectangle.area * Extent(hull.corners, normal);
    if (volume < least) {
      least = volume;
      Eigen::Matrix3d& axes = best.emplace();
      axes.col(0) = normal;
      axes.col(1) = rectangle.side.x() * right + rectangle.side.y() * up;
      axes.col(2) = axes.col(0).cross(axes.col(1));
    }
  }
  return best;
}

}  // namespace hullslam
