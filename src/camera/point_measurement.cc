// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/point_measurement.h"

#include "camera/right_column.h"

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

}  // namespace hullslam
