// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "camera/rgbd_projection.h"
#include "costs/pose_manifold.h"

namespace hullslam::internal {

inline constexpr double kMinDepth = 1e-3;  // m; a nearer point has no usable projection

// Residual and Jacobians of a reprojection error with kRows rows: 2 for the pixel alone, 3 for the
// pixel and the disparity.
template <int kRows>
bool EvaluateReprojection(const PinholeCamera& camera,
                          const Eigen::Matrix<double, kRows, 1>& measured,
                          const Eigen::Matrix<double, kRows, 1>& inverse_sigma,
                          double const* const* parameters, double* residuals, double** jacobians) {
  const Eigen::Map<const Eigen::Quaterniond> rotation(parameters[0]);
  const Eigen::Map<const Eigen::Vector3d> translation(parameters[0] + 4);
  const Eigen::Map<const Eigen::Vector3d> point(parameters[1]);
  const Eigen::Matrix3d cam_from_world = rotation.toRotationMatrix();
  const Eigen::Vector3d point_in_cam = cam_from_world * point + translation;
  if (point_in_cam.z() < kMinDepth) {
    return false;
  }
  Eigen::Map<Eigen::Matrix<double, kRows, 1>> residual(residuals);
  residual = inverse_sigma.cwiseProduct(ProjectRgbd(camera, point_in_cam).template head<kRows>() -
                                        measured);
  if (jacobians == nullptr) {
    return true;
  }
  const Eigen::Matrix<double, kRows, 3> by_point_in_cam =
      inverse_sigma.asDiagonal() *
      ProjectRgbdJacobian(camera, point_in_cam).template topRows<kRows>();
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, kRows, 7, Eigen::RowMajor>> by_pose(jacobians[0]);
    by_pose.template leftCols<3>() = -by_point_in_cam * Skew(point_in_cam);
    by_pose.template middleCols<3>(3) = by_point_in_cam;
    by_pose.col(6).setZero();
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, kRows, 3, Eigen::RowMajor>> by_point(jacobians[1]);
    by_point = by_point_in_cam * cam_from_world;
  }
  return true;
}

}  // namespace hullslam::internal
