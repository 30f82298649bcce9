// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "synthetic/shape.h"

namespace hullslam::synthetic {

// The implicit function of a superquadric (Barr 1981) with half axes of 1.
inline double ImplicitSuperquadric(const Shape& shape, const Eigen::Vector3d& q) {
  const double around =
      std::pow(std::abs(q.x()), 2.0 / shape.east) + std::pow(std::abs(q.y()), 2.0 / shape.east);
  const double sum =
      std::pow(around, shape.east / shape.north) + std::pow(std::abs(q.z()), 2.0 / shape.north);
  return std::pow(sum, shape.north / 2.0) - 1.0;
}

// The distance to the profile divided by the size, negative inside. A point is inside if a line
// from it away from the axis crosses the profile an odd number of times.
inline double ImplicitRevolved(const Shape& shape, const Eigen::Vector3d& point) {
  const Eigen::Vector2d flat(point.head<2>().norm(), point.z());
  double nearest = std::numeric_limits<double>::infinity();
  bool is_inside = false;
  for (size_t i = 1; i < shape.profile.size(); ++i) {
    const Eigen::Vector2d& from = shape.profile[i - 1];
    const Eigen::Vector2d along = shape.profile[i] - from;
    const double share = std::clamp((flat - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (flat - from - share * along).norm());
    if ((from.y() > flat.y()) != (shape.profile[i].y() > flat.y())) {
      const double crossing = from.x() + along.x() * (flat.y() - from.y()) / along.y();
      is_inside = is_inside != (crossing > flat.x());
    }
  }
  return (is_inside ? -nearest : nearest) / shape.half.maxCoeff();
}

// The implicit function of a shape: negative inside, 0 on the surface, positive outside. It has no
// unit and is roughly the distance divided by the size.
inline double Implicit(const Shape& shape, const Eigen::Vector3d& point) {
  const Eigen::Vector3d q = point.cwiseQuotient(shape.half);
  switch (shape.kind) {
    case ShapeKind::kBox:
      return q.lpNorm<Eigen::Infinity>() - 1.0;
    case ShapeKind::kEllipsoid:
      return q.norm() - 1.0;
    case ShapeKind::kSuperquadric:
      return ImplicitSuperquadric(shape, q);
    case ShapeKind::kCylinder:
      return std::max(q.head<2>().norm(), std::abs(q.z())) - 1.0;
    case ShapeKind::kRevolved:
      return ImplicitRevolved(shape, point);
    case ShapeKind::kTorus:
      break;
  }
  const double ring = shape.half.x() - shape.tube;
  return std::hypot(std::hypot(point.x(), point.z()) - ring, point.y()) / shape.tube - 1.0;
}

}  // namespace hullslam::synthetic
