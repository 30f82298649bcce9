// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>

#include "geometry/oriented_box.h"
#include "objects/initialisation.h"
#include "objects/start_method.h"

namespace hullslam {
namespace {

constexpr size_t kLeastPoints = 5;

// The landmarks of all observations in the world frame. Observations that show the same landmark
// have it in their own frames, so in the world its positions differ by rounding errors.
std::vector<Eigen::Vector3d> LandmarksOf(std::span<const ResolvedObservation> observations,
                                         double distance) {
  const double same = 1e-9 * distance;
  std::vector<Eigen::Vector3d> landmarks;
  for (const ResolvedObservation& observation : observations) {
    const Rigid3 world_from_cam = Inverse(observation.cam_from_world);
    for (const Eigen::Vector3d& landmark : observation.landmarks) {
      const Eigen::Vector3d position = world_from_cam * landmark;
      if (std::none_of(landmarks.begin(), landmarks.end(), [&](const Eigen::Vector3d& known) {
            return (known - position).cwiseAbs().maxCoeff() < same;
          })) {
        landmarks.push_back(position);
      }
    }
  }
  return landmarks;
}

}  // namespace

std::vector<Ellipsoid> StartByOrientedBox(const StartInput& input) {
  const double distance = MeanDistance(input.observations, input.center);
  const std::vector<Eigen::Vector3d> points =
      input.has_depth
          ? CollectPoints(input.observations, static_cast<size_t>(input.options.max_points))
          : LandmarksOf(input.observations, distance);
  if (points.size() < kLeastPoints) {
    return {};
  }
  const std::optional<Eigen::Matrix3d> axes = OrientedBoxAxes(points);
  if (!axes) {
    return {};
  }
  return {FitAlong(points, *axes, distance, input.options)};
}

}  // namespace hullslam
