// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hullslam {

// A directed line of the image: points p with normal . p + offset = 0; normal has unit length. For
// a line of a silhouette the normal points out of the object.
struct Line2 {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset = 0.0;  // px

  // Distance of a point, px; positive on the side the normal points to.
  double SignedDistance(const Eigen::Vector2d& point) const { return normal.dot(point) + offset; }
  // (normal, offset), the line in homogeneous coordinates.
  Eigen::Vector3d Homogeneous() const { return {normal.x(), normal.y(), offset}; }
};

// A line that bounds an object in the image. A one-sided one (the object is cut by the image border
// or hidden by something nearer) says only that the object reaches at least this far.
struct SilhouetteLine {
  Line2 line;
  bool is_one_sided = false;
};

}  // namespace hullslam
