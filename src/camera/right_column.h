// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "camera/point_measurement.h"

namespace hullslam {

// The depth error model `right_column` (Mur-Artal and Tardos 2017, section III.A): a keypoint with
// depth stands for the three columns and rows (u, v, u_r) of a stereo camera, u_r = u - disparity,
// whose errors are independent and have the same `sigma` (px), which grows with the level of the
// keypoint. So the error of u is part of the error of the depth. With e = du, d = d disparity,
//   e^2 + (e - d)^2 = 2 (e - d / 2)^2 + d^2 / 2,
// so the squared norm of PointResidual is that of the three errors over sigma if the residual of u
// is that of u - disparity / 2 with the sigma sigma / sqrt(2), and that of the disparity has the
// sigma sqrt(2) sigma. Without disparity, only u and v count.
PointMeasurement MeasureRightColumn(const Eigen::Vector2d& pixel, double sigma,
                                    std::optional<double> disparity);

}  // namespace hullslam
