// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/start_oriented_box.h"

#include <optional>

#include "geometry/oriented_box.h"
#include "objects/initialisation.h"

namespace hullslam {
namespace {

constexpr size_t kLeastPoints = 5;

// The landmarks of all views in the world frame. A landmark that several views show is taken once
// for each of them, which does not change its box.
std::vector<Eigen::Vector3d> LandmarksOf(std::span<const ObjectView> views) {
  std::vector<Eigen::Vector3d> landmarks;
  for (const ObjectView& view : views) {
    const Rigid3 world_from_cam = Inverse(view.cam_from_world);
    for (const Eigen::Vector3d& landmark : view.landmarks) {
      landmarks.push_back(world_from_cam * landmark);
    }
  }
  return landmarks;
}

}  // namespace

std::vector<Ellipsoid> StartByOrientedBox(const StartInput& input) {
  const std::vector<Eigen::Vector3d> points =
      input.has_depth ? CollectPoints(input.views, static_cast<size_t>(input.options.max_points))
                      : LandmarksOf(input.views);
  if (points.size() < kLeastPoints) {
    return {};
  }
  const std::optional<Eigen::Matrix3d> axes = OrientedBoxAxes(points);
  if (!axes) {
    return {};
  }
  return {FitAlong(points, *axes, MeanDistance(input.views, input.center), input.options)};
}

}  // namespace hullslam
