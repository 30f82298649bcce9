// SPDX-License-Identifier: GPL-3.0-or-later
#include "places/depth_agreement.h"

#include <algorithm>
#include <cmath>

#include "camera/point_measurement.h"
#include "frame/measure_point.h"

namespace hullslam {
namespace {

constexpr int kStepOfSamples = 2;  // of the depth grid, in each direction
// Depths that differ by less than this share are the same: the depth of a phone is wrong by 1 to
// 5 % at an arm's length, far more than the error of a disparity.
constexpr double kSameDepth = 0.1;

// The tolerance of LookAt for a point of this depth (m).
double ToleranceAt(const Sensor& sensor, double depth, double least) {
  const double bound = std::sqrt(2.0 * Chi2Bound(1)) * sensor.depth_error.disparity_sigma;
  return std::max(least, kSameDepth * sensor.camera.bf / depth / bound);
}

DepthAgreement LookFrom(const Sensor& sensor, const Frame& from, const Frame& at,
                        const Rigid3& at_from_cam, double tolerance) {
  DepthAgreement agreement;
  for (int row = 0; row < from.depth.rows(); row += kStepOfSamples) {
    for (int column = 0; column < from.depth.columns(); column += kStepOfSamples) {
      const double z = from.depth.At(column, row);
      if (z <= 0.0) {
        continue;
      }
      const Eigen::Vector2d pixel = sensor.camera.Undistort(DepthGrid::RawPixel(column, row));
      const Eigen::Vector3d point = at_from_cam * sensor.camera.Unproject(pixel, z);
      if (point.z() < kMinDepth || !sensor.Sees(sensor.camera.Project(point))) {
        continue;
      }
      const Sight sight = LookAt(sensor, at.depth, sensor.camera.Project(point), point,
                                 ToleranceAt(sensor, point.z(), tolerance));
      agreement.surface += sight == Sight::kSurface ? 1 : 0;
      agreement.past += sight == Sight::kPast ? 1 : 0;
    }
  }
  return agreement;
}

}  // namespace

DepthAgreement CompareDepths(const Sensor& sensor, const Frame& a, const Frame& b,
                             const Rigid3& b_from_a, double tolerance) {
  if (a.depth.empty() || b.depth.empty()) {
    return {};
  }
  DepthAgreement agreement = LookFrom(sensor, a, b, b_from_a, tolerance);
  agreement.Add(LookFrom(sensor, b, a, Inverse(b_from_a), tolerance));
  return agreement;
}

}  // namespace hullslam
