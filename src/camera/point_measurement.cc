// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/point_measurement.h"

#include <cmath>
#include <numbers>

namespace hullslam {

PointMeasurement PointMeasurement::Create(const Eigen::Vector2d& pixel, double scale,
                                          std::optional<double> disparity,
                                          const DepthErrorOptions& options) {
  if (options.model == DepthErrorModel::kRightColumn) {
    return MeasureRightColumn(pixel, options.pixel_sigma * scale, disparity);
  }
  PointMeasurement measurement;
  measurement.measured << pixel, disparity.value_or(0.0);
  const double inverse_sigma = 1.0 / (options.pixel_sigma * scale);
  measurement.inverse_sigma << inverse_sigma, inverse_sigma,
      disparity ? 1.0 / options.disparity_sigma : 0.0;
  return measurement;
}

// With the errors e of the raw pixel and e = J d, the squared norm of e over sigma is that of U d,
// U^T U = J^T J. The upper triangular U makes the residual of v depend on dv only.
void PointMeasurement::TakeLens(const Eigen::Matrix2d& raw_by_undistorted) {
  const Eigen::Matrix2d square = raw_by_undistorted.transpose() * raw_by_undistorted;
  const double u = std::sqrt(square(0, 0));
  const double uv = square(0, 1) / u;
  shear = -uv / u;
  inverse_sigma.x() *= u;
  inverse_sigma.y() *= std::sqrt(square(1, 1) - uv * uv);
}

PointMeasurement MeasureRightColumn(const Eigen::Vector2d& pixel, double sigma,
                                    std::optional<double> disparity) {
  constexpr double kRoot2 = std::numbers::sqrt2;
  PointMeasurement measurement;
  measurement.measured << pixel, disparity.value_or(0.0);
  if (disparity) {
    measurement.inverse_sigma << kRoot2 / sigma, 1.0 / sigma, 1.0 / (kRoot2 * sigma);
    measurement.coupling = 0.5;
  } else {
    measurement.inverse_sigma << 1.0 / sigma, 1.0 / sigma, 0.0;
  }
  return measurement;
}

}  // namespace hullslam
