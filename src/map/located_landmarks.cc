// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/located_landmarks.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "camera/point_measurement.h"
#include "frame/measure_point.h"

namespace hullslam {
namespace {

// The inverse covariance of the position that follows from all observations, world frame.
Eigen::Matrix3d InformationOf(const Map& map, const Landmark& landmark, const Sensor& sensor) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const Observation& seen : landmark.observations) {
    const Keyframe& keyframe = map.keyframes().At(seen.keyframe);
    const Eigen::Vector3d in_camera = keyframe.cam_from_world * landmark.position;
    if (in_camera.z() < kMinDepth) {
      continue;
    }
    const PointMeasurement measurement =
        MeasurePoint(sensor, keyframe.frame->features, seen.keypoint, sensor.depth_error);
    const Eigen::Matrix3d by_world = PointResidualJacobian(sensor.camera, measurement, in_camera) *
                                     keyframe.cam_from_world.rotation.toRotationMatrix();
    information += by_world.transpose() * by_world;
  }
  return information;
}

}  // namespace

bool IsDistanceKnown(const Map& map, const Landmark& landmark, const Sensor& sensor) {
  constexpr double kLeastSigmas = 2.0;
  if (landmark.observations.empty()) {
    return false;
  }
  const Keyframe& keyframe = map.keyframes().At(landmark.observations.front().keyframe);
  const Eigen::Vector3d ray = landmark.position - Inverse(keyframe.cam_from_world).translation;
  const double distance = ray.norm();
  const Eigen::Vector3d direction = ray / distance;
  const Eigen::LDLT<Eigen::Matrix3d> information(InformationOf(map, landmark, sensor));
  const double variance = direction.dot(information.solve(direction));
  return information.isPositive() && variance > 0.0 &&
         distance >= kLeastSigmas * std::sqrt(variance);
}

LocatedLandmarks LocateLandmarks(const Map& map, const Sensor& sensor) {
  LocatedLandmarks located;
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    if (IsDistanceKnown(map, landmark, sensor)) {
      located.positions.push_back(landmark.position);
      located.ids.push_back(id);
    } else {
      ++located.at_infinity;
    }
  });
  return located;
}

}  // namespace hullslam
