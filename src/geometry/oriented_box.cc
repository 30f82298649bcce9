// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/oriented_box.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/optimal_bounding_box.h>

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace hullslam {

std::optional<Eigen::Matrix3d> OrientedBoxAxes(std::span<const Eigen::Vector3d> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  if (points.size() < 4) {
    return std::nullopt;
  }
  std::vector<Kernel::Point_3> input;
  input.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    input.emplace_back(point.x(), point.y(), point.z());
  }
  std::array<Kernel::Point_3, 8> corners;
  // The search is a genetic algorithm that draws from the random generator of this thread in CGAL.
  // It is seeded for each call, so that the same points give the same box.
  CGAL::get_default_random() = CGAL::Random(0);
  CGAL::oriented_bounding_box(input, corners);
  const auto edge = [&](size_t to) {
    const Kernel::Vector_3 vector = corners[to] - corners[0];
    return Eigen::Vector3d(vector.x(), vector.y(), vector.z());
  };
  // Corners 1, 3 and 5 are the neighbours of corner 0. A flat box has an edge without direction.
  Eigen::Matrix3d axes;
  axes.col(0) = edge(1).normalized();
  axes.col(1) = (edge(3) - edge(3).dot(axes.col(0)) * axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes.allFinite() ? std::optional(axes) : std::nullopt;
}

}  // namespace hullslam
