// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/mask_camera.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "camera/wide_lens.h"
#include "geometry/polygon.h"

namespace hullslam {
namespace {

// The mean direction of the points of the outlines. A few points of each outline are enough.
Eigen::Vector3d MeanRay(const PinholeCamera& camera,
                        std::span<const std::vector<Eigen::Vector2d>> outlines) {
  constexpr size_t kPoints = 64;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::vector<Eigen::Vector2d>& outline : outlines) {
    const size_t step = std::max<size_t>(1, outline.size() / kPoints);
    for (size_t i = 0; i < outline.size(); i += step) {
      sum += camera.Unproject(camera.Undistort(outline[i]), 1.0).normalized();
    }
  }
  return sum.norm() > 0.0 ? sum.normalized() : Eigen::Vector3d::UnitZ();
}

}  // namespace

MaskCamera::MaskCamera(const PinholeCamera& camera) : camera_(camera), focal_(camera.fx) {}

// An area of the plane z = 1 in the direction c of unit length is the solid angle over c_z^3.
MaskCamera::MaskCamera(const PinholeCamera& camera,
                       std::span<const std::vector<Eigen::Vector2d>> outlines)
    : MaskCamera(camera) {
  if (!camera.IsWide()) {
    return;
  }
  is_turned_ = true;
  const Eigen::Vector3d ray = MeanRay(camera, outlines);
  const Eigen::Vector2d pixel = camera.Project(ray);
  view_from_cam_ =
      Eigen::Quaterniond::FromTwoVectors(ray, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  focal_ = std::sqrt(camera.DistortionJacobian(pixel).determinant() * camera.fx * camera.fy /
                     std::pow(ray.z(), 3));
  center_ = camera.Distort(pixel);
}

Eigen::Vector3d MaskCamera::RayOf(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d offset = (pixel - center_) / focal_;
  return view_from_cam_.transpose() * offset.homogeneous();
}

Eigen::Vector2d MaskCamera::Undistort(const Eigen::Vector2d& raw) const {
  const Eigen::Vector2d undistorted = camera_.Undistort(raw);
  if (!is_turned_) {
    return undistorted;
  }
  // A mask that reaches more than 87 degrees away from its own direction is cut there.
  constexpr double kLeastCosine = 0.05;
  const Eigen::Vector3d ray = view_from_cam_ * camera_.Unproject(undistorted, 1.0).normalized();
  return center_ + focal_ / std::max(kLeastCosine, ray.z()) * ray.head<2>();
}

Eigen::Vector2d MaskCamera::Distort(const Eigen::Vector2d& pixel) const {
  return is_turned_ ? RawPixelOfRay(camera_, RayOf(pixel)) : camera_.Distort(pixel);
}

bool MaskCamera::IsAtBorder(const Eigen::Vector2d& pixel, double border) const {
  const Eigen::Vector2d raw = Distort(pixel);
  const bool is_at_side = raw.x() <= border || raw.y() <= border ||
                          raw.x() >= camera_.width - 1 - border ||
                          raw.y() >= camera_.height - 1 - border;
  if (is_at_side || !is_turned_) {
    return is_at_side;
  }
  const Eigen::Vector2d point((raw.x() - camera_.cx) / camera_.fx,
                              (raw.y() - camera_.cy) / camera_.fy);
  return point.norm() + border / camera_.fx >= RadiusOfAngle(camera_, PinholeCamera::kMostAngle);
}

void MaskCamera::ToUndistorted(Detection& detection) const {
  if (!is_turned_) {
    return;
  }
  const auto move = [&](const Eigen::Vector2d& pixel) { return camera_.Project(RayOf(pixel)); };
  std::vector<Eigen::Vector2d> contour;
  for (const Eigen::Vector2d& point : detection.contour.Unpack()) {
    contour.push_back(move(point));
  }
  detection.contour = contour;
  for (Eigen::Vector2d& corner : detection.hull) {
    corner = move(corner);
  }
  detection.box = BoundingBox(detection.hull);
  Eigen::Matrix3d view_matrix;
  view_matrix << focal_, 0.0, center_.x(), 0.0, focal_, center_.y(), 0.0, 0.0, 1.0;
  const Eigen::Matrix3d homography =
      camera_.Matrix() * view_from_cam_.transpose() * view_matrix.inverse();
  // x' ~ H x, so a line l of the points x is H^-T l, and a dual conic C is H C H^T.
  const Eigen::Matrix3d line_map = homography.inverse().transpose();
  for (SilhouetteLine& line : detection.lines) {
    const Eigen::Vector3d moved = line_map * line.line.Homogeneous();
    const double length = moved.head<2>().norm();
    line.line = {.normal = moved.head<2>() / length, .offset = moved.z() / length};
  }
  if (detection.ellipse) {
    detection.ellipse =
        EllipseFromDualConic(homography * detection.ellipse->DualConic() * homography.transpose());
  }
}

}  // namespace hullslam
