// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/measure_point.h"

#include <optional>

namespace hullslam {

PointMeasurement MeasurePoint(const Sensor& sensor, const FrameFeatures& features,
                              uint32_t keypoint, const DepthErrorOptions& error) {
  const Keypoint& seen = features.keypoints[keypoint];
  const Eigen::Vector2d pixel = seen.undistorted.cast<double>();
  const double depth = static_cast<double>(features.depth[keypoint]);
  const auto disparity = depth > 0.0 ? std::optional(sensor.camera.bf / depth) : std::nullopt;
  const double scale = static_cast<double>(sensor.levels.scale[static_cast<size_t>(seen.level)]);
  PointMeasurement measurement = PointMeasurement::Create(pixel, scale, disparity, error);
  if (sensor.camera.IsDistorted()) {
    measurement.TakeLens(sensor.camera.DistortionJacobian(pixel));
  }
  return measurement;
}

Sensor WithWideErrors(Sensor sensor) {
  sensor.depth_error.pixel_sigma *= kWideErrorFactor;
  sensor.depth_error.adjustment_pixel_sigma *= kWideErrorFactor;
  sensor.depth_error.disparity_sigma *= kWideErrorFactor;
  return sensor;
}

}  // namespace hullslam
