// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/carried_hull.h"

#include "frame/detection/visible_part.h"
#include "geometry/polygon.h"
#include "objects/constraint/point_statistics.h"
#include "objects/initialisation.h"

namespace hullslam {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

// Inverse depths from 0 to the value at which the hull moves by its own size.
std::vector<double> PossibleInverseDepths(const PinholeCamera& camera, const Detection& detection,
                                          const Rigid3& now_from_then) {
  constexpr int kSteps = 4;
  const Eigen::Vector3d ray = camera.Unproject(detection.box.center(), 1.0);
  const Eigen::Vector3d far = now_from_then.rotation * ray;
  if (far.z() <= 0.0) {
    return {};
  }
  // Derivative of the pixel by the inverse depth where it is 0.
  const Eigen::Vector2d slope =
      Eigen::Vector2d(camera.fx, camera.fy)
          .cwiseProduct(now_from_then.translation.head<2>() / far.z() -
                        far.head<2>() * now_from_then.translation.z() / (far.z() * far.z()));
  const double size = detection.box.sizes().minCoeff();
  std::vector<double> inverse_depths = {0.0};
  if (slope.norm() > 1.0) {  // px m; a smaller slope moves the hull too little
    for (int i = 1; i <= kSteps; ++i) {
      inverse_depths.push_back(i * size / (kSteps * slope.norm()));
    }
  }
  return inverse_depths;
}

std::vector<double> InverseDepths(const PinholeCamera& camera,
                                  std::span<const ResolvedObservation> observations,
                                  const Rigid3& now_from_then) {
  const ResolvedObservation& last = observations.back();
  if (!last.detection->points.empty()) {
    return {1.0 / MeanOf(last.detection->points.Unpack()).z()};
  }
  if (const auto depth = LandmarkDepth(last)) {
    return {1.0 / *depth};
  }
  if (const auto sphere = StartFromRays(camera, observations, {})) {
    return {1.0 / (last.cam_from_world * sphere->world_from_object.translation).z()};
  }
  return PossibleInverseDepths(camera, *last.detection, now_from_then);
}

Polygon Move(const PinholeCamera& camera, const Polygon& hull, double inverse_depth,
             const Rigid3& now_from_then) {
  Polygon moved;
  for (const Eigen::Vector2d& corner : hull) {
    const Eigen::Vector3d point = now_from_then.rotation * camera.Unproject(corner, 1.0) +
                                  inverse_depth * now_from_then.translation;
    if (point.z() <= 0.0) {
      return {};
    }
    moved.push_back(camera.Project(point));
  }
  return ConvexHull(moved);
}

}  // namespace

std::vector<Polygon> CarryHull(const Sensor& sensor,
                               std::span<const ResolvedObservation> observations,
                               const Rigid3& cam_from_world) {
  const ResolvedObservation& last = observations.back();
  const Rigid3 now_from_then = cam_from_world * Inverse(last.cam_from_world);
  const PinholeCamera::Bounds& bounds = sensor.bounds;
  const Eigen::AlignedBox2d image(Eigen::Vector2d(bounds.min_x, bounds.min_y),
                                  Eigen::Vector2d(bounds.max_x, bounds.max_y));
  std::vector<Polygon> carried;
  for (const double inverse_depth : InverseDepths(sensor.camera, observations, now_from_then)) {
    const Polygon moved = Move(sensor.camera, last.detection->hull, inverse_depth, now_from_then);
    carried.push_back(moved.empty() ? moved : VisiblePart(moved, sensor.camera, image));
  }
  return carried;
}

}  // namespace hullslam
