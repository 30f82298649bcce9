// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/p3p.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <vector>

namespace hullslam {

bool SpansTriangle(const std::array<Eigen::Vector3d, 3>& points) {
  constexpr double kLeastHeight = 0.01;  // as a share of the longest side
  const Eigen::Vector3d first = points[1] - points[0];
  const Eigen::Vector3d second = points[2] - points[0];
  const double longest =
      std::max({first.squaredNorm(), second.squaredNorm(), (second - first).squaredNorm()});
  const double area = first.cross(second).norm();
  return area > 0.0 && area >= kLeastHeight * longest;
}

// OpenCV takes pixels in place of rays, so the rays are turned until their mean is the axis of a
// camera. The points are scaled, so that rounding does not depend on the unit of length.
P3pPoses SolveP3p(const std::array<Eigen::Vector3d, 3>& rays,
                  const std::array<Eigen::Vector3d, 3>& points) {
  P3pPoses poses;
  const Eigen::Vector3d middle = rays[0].normalized() + rays[1].normalized() + rays[2].normalized();
  if (!SpansTriangle(points) || !middle.allFinite()) {
    return poses;
  }
  const auto turn = Eigen::Quaterniond::FromTwoVectors(middle, Eigen::Vector3d::UnitZ());
  const double size = (points[1] - points[0]).norm();
  std::vector<cv::Point3d> corners;
  std::vector<cv::Point2d> pixels;
  for (size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d corner = (points[i] - points[0]) / size;
    corners.emplace_back(corner.x(), corner.y(), corner.z());
    const Eigen::Vector3d ray = turn * rays[i];
    pixels.emplace_back(ray.x() / ray.z(), ray.y() / ray.z());
  }
  std::vector<cv::Vec3d> rotations;
  std::vector<cv::Vec3d> translations;
  cv::solveP3P(corners, pixels, cv::Matx33d::eye(), cv::noArray(), rotations, translations,
               cv::SOLVEPNP_AP3P);
  for (size_t i = 0; i < std::min<size_t>(rotations.size(), 4); ++i) {
    Rigid3 pose(turn.conjugate() * ExpSo3({rotations[i][0], rotations[i][1], rotations[i][2]}),
                turn.conjugate() * (size * Eigen::Vector3d(translations[i][0], translations[i][1],
                                                           translations[i][2])));
    pose.translation -= pose.rotation * points[0];
    const bool is_seen = std::ranges::all_of(std::array<size_t, 3>{0, 1, 2}, [&](size_t k) {
      return ((pose * points[k]).normalized() - rays[k].normalized()).norm() < 1e-5;
    });
    if (is_seen) {
      poses.cam_from_world[poses.count++] = pose;
    }
  }
  return poses;
}

}  // namespace hullslam
