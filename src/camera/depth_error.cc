// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/depth_error.h"

#include <limits>

#include "util/chi_square.h"

namespace hullslam {

PointMeasurement PointMeasurement::Create(const Eigen::Vector2d& pixel, double scale,
                                          std::optional<double> disparity,
                                          const DepthErrorOptions& options) {
  PointMeasurement measurement;
  measurement.measured << pixel, disparity.value_or(0.0);
  const double inverse_sigma = 1.0 / (options.pixel_sigma * scale);
  measurement.inverse_sigma << inverse_sigma, inverse_sigma,
      disparity ? 1.0 / options.disparity_sigma : 0.0;
  return measurement;
}

double PointChi2(const PinholeCamera& camera, const PointMeasurement& measurement,
                 const Eigen::Vector3d& point) {
  return point.z() < kMinDepth ? std::numeric_limits<double>::infinity()
                               : PointResidual(camera, measurement, point).squaredNorm();
}

double OutlierBound(const PointMeasurement& measurement) {
  return Chi2Bound(measurement.degrees_of_freedom());
}

bool IsInlier(const PinholeCamera& camera, const PointMeasurement& measurement,
              const Eigen::Vector3d& point) {
  return PointChi2(camera, measurement, point) <= OutlierBound(measurement);
}

}  // namespace hullslam
