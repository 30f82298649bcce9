// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/measure_point.h"

#include <optional>

namespace hullslam {

PointMeasurement MeasurePoint(const Sensor& sensor, const FrameFeatures& features,
                              uint32_t keypoint, const DepthErrorOptions& error) {
  const Keypoint& seen = features.keypoints[keypoint];
  const Eigen::Vector2d pixel = seen.undistorted.cast<double>();
  const double right_u = static_cast<double>(features.right_u[keypoint]);
  std::optional<double> disparity;
  if (right_u >= 0.0) {
    disparity = sensor.camera.FarRight(pixel.x()) - right_u;
  }
  const double scale = static_cast<double>(sensor.levels.scale[static_cast<size_t>(seen.level)]);
  PointMeasurement measurement = PointMeasurement::Create(pixel, scale, disparity, error);
  if (sensor.camera.IsFisheye()) {
    measurement.TakeLens(sensor.camera.DistortionJacobian(pixel));
  }
  return measurement;
}

}  // namespace hullslam
