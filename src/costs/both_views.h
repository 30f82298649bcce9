// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>

#include "costs/quadric_in_camera.h"

namespace hullslam {

// The rows of a cost of the left image of a rectified pair, and below them the rows of one of the
// right image. The right camera is the left one shifted by the baseline b along its x axis, so its
// pose is the left one's with t - (b, 0, 0)^T.
//
// Jacobian of the right rows: a change (omega, v) of the left pose moves a point x of its frame by
// omega x x + v. In the right camera the point is y = x + s with s = (-b, 0, 0)^T, and moves by as
// much: omega x y + (v + s x omega). So a row (g_omega, g_v) by the pose of the right camera is
// (g_omega + g_v x s, g_v) by the pose of the left one.
class BothViewsCost final : public ObjectCost {
 public:
  // `baseline` in m. Both costs are of the same object.
  BothViewsCost(std::unique_ptr<ceres::CostFunction> left,
                std::unique_ptr<ceres::CostFunction> right, double baseline);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  std::unique_ptr<ceres::CostFunction> left_;
  std::unique_ptr<ceres::CostFunction> right_;
  Eigen::Vector3d right_from_left_;  // translation
};

}  // namespace hullslam
