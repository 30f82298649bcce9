// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/raw_lines.h"

#include <Eigen/LU>
#include <algorithm>

namespace hullslam {

double RawShare(const PinholeCamera& camera, const Eigen::Vector2d& undistorted,
                const Eigen::Vector2d& normal) {
  const Eigen::Matrix2d jacobian = camera.DistortionJacobian(undistorted);
  return 1.0 / (jacobian.inverse().transpose() * normal).norm();
}

std::vector<SilhouetteLine> ScaleToRaw(const PinholeCamera& camera, const Detection& detection,
                                       std::span<const SilhouetteLine> lines) {
  std::vector<SilhouetteLine> scaled(lines.begin(), lines.end());
  if (!camera.IsDistorted() || detection.hull.empty()) {
    return scaled;
  }
  for (SilhouetteLine& line : scaled) {
    const Eigen::Vector2d normal = line.line.normal;
    const auto touching = std::max_element(
        detection.hull.begin(), detection.hull.end(),
        [&](const auto& a, const auto& b) { return normal.dot(a) < normal.dot(b); });
    const double share = RawShare(camera, *touching, normal);
    line.line.normal *= share;
    line.line.offset *= share;
  }
  return scaled;
}

}  // namespace hullslam
