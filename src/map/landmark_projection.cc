// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/landmark_projection.h"

namespace hullslam {
namespace {

constexpr double kMinCosView = 0.5;      // 60 degrees
constexpr double kDistanceMargin = 1.2;  // at both ends of the range; one level of the pyramid

}  // namespace

std::optional<LandmarkProjection> ProjectLandmark(const Sensor& sensor,
                                                  const MatrixPose& cam_from_world,
                                                  const Landmark& landmark) {
  LandmarkProjection view;
  view.point_in_cam = cam_from_world * landmark.position;
  if (view.point_in_cam.z() <= 0.0) {
    return std::nullopt;
  }
  const double distance = view.point_in_cam.norm();
  if (distance * kDistanceMargin < landmark.min_distance ||
      distance > landmark.max_distance * kDistanceMargin) {
    return std::nullopt;
  }
  const Eigen::Vector3d direction_in_cam = cam_from_world.rotation * landmark.viewing_direction;
  view.cos_view = view.point_in_cam.dot(direction_in_cam) / distance;
  if (view.cos_view < kMinCosView) {
    return std::nullopt;
  }
  view.pixel = sensor.camera.Project(view.point_in_cam);
  const std::optional<Eigen::Vector2d> raw = sensor.RawPixel(view.pixel);
  if (!raw) {
    return std::nullopt;
  }
  view.raw_pixel = *raw;
  view.level = sensor.levels.PredictLevel(distance, landmark.max_distance);
  return view;
}

}  // namespace hullslam
