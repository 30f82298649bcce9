// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/right_column.h"

#include <numbers>

namespace hullslam {

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
