// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>

#include "objects/start_method.h"

namespace hullslam {
namespace {

constexpr double kLeastThickness = 0.05;  // m
constexpr double kMostThickness = 0.2;    // m
constexpr double kTrimmed = 0.05;         // share of the depths at each end that is not counted

std::vector<double> SortedDepths(const Detection& detection) {
  std::vector<double> depths;
  for (const Eigen::Vector3d& point : detection.points.Unpack()) {
    depths.push_back(point.z());
  }
  std::sort(depths.begin(), depths.end());
  return depths;
}

// The axes of an object that faces the camera, in the camera's frame: to the right, down and along
// the ray to its centre.
Eigen::Matrix3d AxesFacing(const Eigen::Vector3d& center) {
  Eigen::Matrix3d axes;
  axes.col(2) = center.normalized();
  axes.col(0) = Eigen::Vector3d::UnitY().cross(axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Ellipsoid EllipsoidOf(const ResolvedObservation& observation, const PinholeCamera& camera) {
  const std::vector<double> depths = SortedDepths(*observation.detection);
  const auto last = static_cast<double>(depths.size() - 1);
  const double depth = depths[depths.size() / 2];
  const double thickness = depths[static_cast<size_t>((1.0 - kTrimmed) * last)] -
                           depths[static_cast<size_t>(kTrimmed * last)];
  const Eigen::AlignedBox2d& box = observation.detection->box;
  const Eigen::Vector3d center = camera.Unproject(box.center(), depth);
  const Rigid3 world_from_cam = Inverse(observation.cam_from_world);
  Ellipsoid ellipsoid;
  ellipsoid.world_from_object =
      world_from_cam * Rigid3(Eigen::Quaterniond(AxesFacing(center)).normalized(), center);
  ellipsoid.half_axes =
      0.5 * Eigen::Vector3d(box.sizes().x() * depth / camera.fx,
                            box.sizes().y() * depth / camera.fy,
                            std::clamp(thickness, kLeastThickness, kMostThickness));
  return ellipsoid;
}

}  // namespace

std::vector<Ellipsoid> StartBySingleView(const StartInput& input) {
  const auto observation = std::find_if(input.observations.begin(), input.observations.end(),
                                        [](const ResolvedObservation& one) {
                                          return one.detection->points.size() >= kMinDepthPoints;
                                        });
  if (observation == input.observations.end()) {
    return StartByRays(input);
  }
  return {EllipsoidOf(*observation, input.camera)};
}

}  // namespace hullslam
