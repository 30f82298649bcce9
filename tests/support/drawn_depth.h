// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"
#include "mesh/make_depth_view.h"

namespace hullslam {

// The distance along a ray of the world (origin, direction) to the first hit, in units of the
// length of the direction; infinite if it hits nothing.
using HitDistance = std::function<double(const Eigen::Vector3d&, const Eigen::Vector3d&)>;

inline HitDistance PlaneAt(const Eigen::Vector3d& normal, double offset) {  // normal * x = offset
  return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const double distance = (offset - normal.dot(origin)) / normal.dot(direction);
    return distance > 0.0 ? distance : std::numeric_limits<double>::infinity();
  };
}

inline HitDistance SphereAt(const Eigen::Vector3d& centre, double radius) {
  return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const double half = direction.dot(centre - origin) / direction.squaredNorm();
    const double c = ((centre - origin).squaredNorm() - radius * radius) / direction.squaredNorm();
    const double root = half * half - c;
    return root >= 0.0 && half > 0.0 ? half - std::sqrt(root)
                                     : std::numeric_limits<double>::infinity();
  };
}

// The depth image, CV_32FC1 in m, of a camera that had one of these poses while each row was
// exposed; a single one for all rows.
inline cv::Mat DrawDepth(const PinholeCamera& camera, std::span<const Rigid3> cam_from_world,
                         const HitDistance& hit) {
  cv::Mat depth = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
  for (int y = 0; y < depth.rows; ++y) {
    const size_t row = cam_from_world.size() > 1 ? static_cast<size_t>(y) : 0;
    const Rigid3 world_from_cam = Inverse(cam_from_world[row]);
    for (int x = 0; x < depth.cols; ++x) {
      const Eigen::Vector2d raw(x, y);
      const Eigen::Vector3d ray = camera.Unproject(camera.Undistort(raw), 1.0);
      const double z = hit(world_from_cam.translation, world_from_cam.rotation * ray);
      depth.at<float>(y, x) = camera.SeesRaw(raw) && std::isfinite(z) ? static_cast<float>(z) : 0;
    }
  }
  return depth;
}

// A small camera, and options with it.
inline SystemOptions SmallCameraOptions() {
  SystemOptions options;
  options.camera = {
      .fx = 160.0, .fy = 160.0, .cx = 79.5, .cy = 59.5, .width = 160, .height = 120, .bf = 12.0};
  return options;
}

// The view of a camera with these poses, in one colour.
inline DepthView DrawView(const SystemOptions& options, std::vector<Rigid3> cam_from_world,
                          const HitDistance& hit, const cv::Scalar& bgr = {30, 20, 10}) {
  cv::Mat seen;
  const cv::Mat rays = RaysOf(options.camera, seen);
  SerialRunner runner;
  DepthView view =
      MakeDepthView(DrawDepth(options.camera, cam_from_world, hit), options, 10.0, rays, runner);
  view.cam_from_world = std::move(cam_from_world);
  view.colour = cv::Mat(view.inverse_depth.size(), CV_8UC3, bgr);
  return view;
}

// A camera at `position` that looks at `target`, with z of the world upwards in its image.
inline Rigid3 LookAt(const Eigen::Vector3d& position, const Eigen::Vector3d& target) {
  const Eigen::Vector3d z = (target - position).normalized();
  const Eigen::Vector3d side =
      std::abs(z.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d x = z.cross(side).normalized();
  Eigen::Matrix3d rotation;
  rotation << x, z.cross(x), z;
  return Inverse(Rigid3(Eigen::Quaterniond(rotation), position));
}

}  // namespace hullslam
