// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/measure_point.h"

#include <cmath>
#include <optional>

#include "util/statistics.h"

namespace hullslam {
namespace {

// Samples of the depth grid on each side of the projection. Two are at least 8 px: color and depth
// images are shifted by some pixels where their stamps differ or the camera turns fast.
constexpr int kSightMargin = 2;

// The depth z (m) of a sample compared with that of a point, in standard deviations; positive if
// the sample is behind the point.
double SigmasBehind(const Sensor& sensor, const Eigen::Vector2d& pixel,
                    const Eigen::Vector3d& point_in_cam, double z) {
  const auto sample =
      PointMeasurement::Create(pixel, 1.0, sensor.camera.bf / z, sensor.depth_error);
  return PointResidual(sensor.camera, sample, point_in_cam).z();
}

}  // namespace

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

Sight LookAt(const Sensor& sensor, const DepthGrid& grid, const Eigen::Vector2d& pixel,
             const Eigen::Vector3d& point_in_cam, double tolerance) {
  // Both the depth of the point and that of the sample have this error.
  const double bound = tolerance * std::sqrt(2.0 * Chi2Bound(1));
  const Eigen::Vector2d sample =
      (sensor.camera.Distort(pixel) - DepthGrid::RawPixel(0, 0)) / DepthGrid::kStep;
  const int first_column = static_cast<int>(std::floor(sample.x())) - kSightMargin + 1;
  const int first_row = static_cast<int>(std::floor(sample.y())) - kSightMargin + 1;
  bool is_past = true;
  for (int row = first_row; row < first_row + 2 * kSightMargin; ++row) {
    for (int column = first_column; column < first_column + 2 * kSightMargin; ++column) {
      const bool is_inside =
          row >= 0 && row < grid.rows() && column >= 0 && column < grid.columns();
      const double z = is_inside ? grid.At(column, row) : 0.0;
      const double behind = z > 0.0 ? SigmasBehind(sensor, pixel, point_in_cam, z) : -HUGE_VAL;
      if (std::abs(behind) <= bound) {
        return Sight::kSurface;
      }
      is_past &= behind > bound;
    }
  }
  return is_past ? Sight::kPast : Sight::kUnclear;
}

// The disparity of a plane is linear in the image.
std::optional<Eigen::Vector2d> DisparitySlope(const PinholeCamera& camera, const DepthGrid& grid,
                                              const Eigen::Vector2d& pixel,
                                              const Eigen::Vector2d& raw_pixel) {
  constexpr double kOtherSurface = 0.3;  // px from the plane
  const Eigen::Vector2d at = (raw_pixel - DepthGrid::RawPixel(0, 0)) / DepthGrid::kStep;
  const int column = static_cast<int>(std::floor(at.x())) - 1;
  const int row = static_cast<int>(std::floor(at.y())) - 1;
  if (column < 0 || row < 0 || column + 3 >= grid.columns() || row + 3 >= grid.rows()) {
    return std::nullopt;
  }
  Eigen::Matrix4d disparities;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      disparities(y, x) = camera.bf / grid.At(column + x, row + y);  // infinite where it is unknown
    }
  }
  const Eigen::Vector4d places(-1.5, -0.5, 0.5, 1.5);
  const double squares = 4.0 * places.squaredNorm();
  const Eigen::RowVector4d ones = Eigen::RowVector4d::Ones();
  const Eigen::Vector2d slope((disparities * places).sum() / squares,
                              (places.transpose() * disparities).sum() / squares);
  const Eigen::Matrix4d plane = (slope.y() * places) * ones +
                                ones.transpose() * (slope.x() * places.transpose()) +
                                Eigen::Matrix4d::Constant(disparities.mean());
  // False if one is not known.
  if (!((disparities - plane).cwiseAbs().maxCoeff() < kOtherSurface)) {
    return std::nullopt;
  }
  return Eigen::Vector2d(camera.DistortionJacobian(pixel).transpose() * slope / DepthGrid::kStep);
}

}  // namespace hullslam
