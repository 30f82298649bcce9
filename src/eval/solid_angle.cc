// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/solid_angle.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "geometry/polygon.h"

namespace hullslam {

// The polygon is a fan of triangles. With unit rays a, b and c to its corners, a triangle has the
// solid angle 2 atan2(a . (b x c), 1 + a . b + b . c + c . a) (Van Oosterom and Strackee 1983).
double SolidAngle(const PinholeCamera& camera, std::span<const Eigen::Vector2d> polygon) {
  double sum = 0.0;
  const auto ray = [&](size_t i) -> Eigen::Vector3d {
    return camera.Unproject(polygon[i], 1.0).normalized();
  };
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Eigen::Vector3d a = ray(0);
    const Eigen::Vector3d b = ray(i);
    const Eigen::Vector3d c = ray(i + 1);
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return sum;
}

double OverlapOnSphere(const PinholeCamera& camera, std::span<const Eigen::Vector2d> polygon,
                       std::span<const Eigen::Vector2d> convex) {
  std::vector<Eigen::Vector2d> shared;
  if (convex.size() >= 3) {
    shared.assign(polygon.begin(), polygon.end());
  }
  for (size_t i = 0; i < convex.size(); ++i) {
    const Eigen::Vector2d side = convex[(i + 1) % convex.size()] - convex[i];
    const Eigen::Vector2d outwards(side.y(), -side.x());
    shared = ClipToHalfPlane(shared, outwards, outwards.dot(convex[i]));
  }
  const double both = SolidAngle(camera, shared);
  const double either = SolidAngle(camera, polygon) + SolidAngle(camera, convex) - both;
  return either > 0.0 ? both / either : 0.0;
}

}  // namespace hullslam
