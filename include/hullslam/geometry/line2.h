// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hullslam {

// A directed line in the image: points p satisfy normal . p + offset = 0, and the normal has unit
// length. If the line bounds a silhouette, the normal points away from the object.
struct Line2 {
  // Not aligned to 16 bytes, because the alignment would enlarge a SilhouetteLine by half.
  Eigen::Matrix<double, 2, 1, Eigen::DontAlign> normal = Eigen::Vector2d::UnitX();
  double offset = 0.0;  // px

  // Signed distance of a point, px; positive on the side to which the normal points.
  double SignedDistance(const Eigen::Vector2d& point) const { return normal.dot(point) + offset; }
  // (normal, offset), the line in homogeneous coordinates.
  Eigen::Vector3d Homogeneous() const { return {normal.x(), normal.y(), offset}; }
};

// A line that bounds an object in the image. It is one-sided if the image border cuts the object
// there or something nearer hides it. The object then reaches at least as far as the line.
struct SilhouetteLine {
  Line2 line;
  bool is_one_sided = false;
};

}  // namespace hullslam
