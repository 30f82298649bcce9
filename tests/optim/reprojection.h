// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Geometry>

#include "camera/point_measurement.h"
#include "costs/manifolds.h"

namespace hullslam {

// Reprojection error of a landmark, in standard deviations: the first kRows rows of PointResidual
// at cam_from_world * point,
//   r = ((u, v, bf / z)(cam_from_world * point) - measured) / (sigma, sigma, disparity_sigma)
// with sigma = pixel_sigma * scale of the level. There are 2 rows for a landmark seen without
// depth, and 3 with the disparity. Parameters: cam_from_world (PoseBlock, with PoseManifold), point
// (m, world frame). Not defined for a point that is not in front of the camera: then Evaluate
// returns false. The tests compare the library, which eliminates points, with it.
template <int kRows>
class PointReprojectionCost final : public ceres::SizedCostFunction<kRows, 7, 3> {
 public:
  PointReprojectionCost(const PinholeCamera& camera, const PointMeasurement& measurement)
      : camera_(camera), measurement_(measurement) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PinholeCamera camera_;
  PointMeasurement measurement_;
};

template <int kRows>
bool PointReprojectionCost<kRows>::Evaluate(double const* const* parameters, double* residuals,
                                            double** jacobians) const {
  const Eigen::Map<const Eigen::Quaterniond> rotation(parameters[0]);
  const Eigen::Map<const Eigen::Vector3d> translation(parameters[0] + 4);
  const Eigen::Map<const Eigen::Vector3d> point(parameters[1]);
  const Eigen::Matrix3d cam_from_world = rotation.toRotationMatrix();
  const Eigen::Vector3d point_in_cam = cam_from_world * point + translation;
  if (point_in_cam.z() < kMinDepth) {
    return false;
  }
  Eigen::Map<Eigen::Matrix<double, kRows, 1>> residual(residuals);
  residual = PointResidual(camera_, measurement_, point_in_cam).template head<kRows>();
  if (jacobians == nullptr) {
    return true;
  }
  const Eigen::Matrix<double, kRows, 3> by_point_in_cam =
      PointResidualJacobian(camera_, measurement_, point_in_cam).template topRows<kRows>();
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

using ReprojectionCost = PointReprojectionCost<2>;
using RgbdReprojectionCost = PointReprojectionCost<3>;

}  // namespace hullslam
