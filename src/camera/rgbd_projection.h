// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// Standard deviation of the disparity bf / z that depth is measured by, px. A sensor of structured
// light errs by the same disparity at all distances (Khoshelham and Elberink 2012), and however
// coarse the pyramid level is that a keypoint was found at; sensors do better than this, but the
// pixel that depth is taken of need not be the landmark's.
inline constexpr double kDisparitySigma = 1.0;

// Pixel (u, v) and disparity bf / z of a point (m, camera frame, z > 0).
inline Eigen::Vector3d ProjectRgbd(const PinholeCamera& camera, const Eigen::Vector3d& point) {
  const double inverse_z = 1.0 / point.z();
  const double u = camera.fx * point.x() * inverse_z + camera.cx;
  return {u, camera.fy * point.y() * inverse_z + camera.cy, camera.bf * inverse_z};
}

// Derivative of ProjectRgbd by the point; its first two rows are those of the pixel.
inline Eigen::Matrix3d ProjectRgbdJacobian(const PinholeCamera& camera,
                                           const Eigen::Vector3d& point) {
  const double inverse_z = 1.0 / point.z();
  const double fx_z = camera.fx * inverse_z;
  const double fy_z = camera.fy * inverse_z;
  const double x_z = point.x() * inverse_z;
  const double y_z = point.y() * inverse_z;
  Eigen::Matrix3d jacobian;
  jacobian << fx_z, 0.0, -fx_z * x_z,  //
      0.0, fy_z, -fy_z * y_z,          //
      0.0, 0.0, -camera.bf * inverse_z * inverse_z;
  return jacobian;
}

}  // namespace hullslam
