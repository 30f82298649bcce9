// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/triangulation.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace hullslam {

Eigen::Matrix3d EssentialFromPose(const Rigid3& b_from_a) {
  return Skew(b_from_a.translation) * b_from_a.rotation.toRotationMatrix();
}

Eigen::Matrix3d FundamentalFromPose(const Rigid3& b_from_a, const Eigen::Matrix3d& k_a,
                                    const Eigen::Matrix3d& k_b) {
  return k_b.inverse().transpose() * EssentialFromPose(b_from_a) * k_a.inverse();
}

std::optional<Eigen::Vector3d> TriangulatePoint(const Rigid3& a_from_world,
                                                const Eigen::Vector2d& point_in_a,
                                                const Rigid3& b_from_world,
                                                const Eigen::Vector2d& point_in_b) {
  const Eigen::Matrix<double, 3, 4> a = a_from_world.ToMatrix();
  const Eigen::Matrix<double, 3, 4> b = b_from_world.ToMatrix();
  Eigen::Matrix4d system;
  system.row(0) = point_in_a.x() * a.row(2) - a.row(0);
  system.row(1) = point_in_a.y() * a.row(2) - a.row(1);
  system.row(2) = point_in_b.x() * b.row(2) - b.row(0);
  system.row(3) = point_in_b.y() * b.row(2) - b.row(1);
  const Eigen::JacobiSVD<Eigen::Matrix4d> svd(system, Eigen::ComputeFullV);
  const Eigen::Vector4d point = svd.matrixV().col(3);
  if (std::abs(point.w()) < 1e-12 * point.head<3>().norm()) {
    return std::nullopt;
  }
  return point.hnormalized();
}

}  // namespace hullslam
