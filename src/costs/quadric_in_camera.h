// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

namespace hullslam {

// Derivative of a number with respect to a small change of an object in the camera frame: a turn
// around its centre (3, radians), a shift (3, m), both along the axes of the camera frame, and a
// change of the logarithms of its half axes (3).
using ByObjectInCamera = Eigen::Matrix<double, 1, 9>;

// An ellipsoid in the camera frame. It is computed from the parameters that all costs of objects
// have, in this order: cam_from_world (PoseBlock), world_from_object (PoseBlock), both with
// PoseManifold, and the logarithms of the half axes (3, log m).
class QuadricInCamera {
 public:
  explicit QuadricInCamera(double const* const* parameters);

  const Eigen::Vector3d& center() const { return center_; }  // m
  // Columns: the half axes as vectors, R_co diag(s), m.
  const Eigen::Matrix3d& axes() const { return axes_; }
  // axes axes^T, m^2: n^T square n is the squared half extent along a unit vector n. The dual
  // quadric's upper left block is square - center center^T.
  const Eigen::Matrix3d& square() const { return square_; }
  const Eigen::Vector3d& half_axes() const { return half_axes_; }  // m
  const Eigen::Matrix3d& cam_from_object() const { return cam_from_object_; }

  // Whether the whole ellipsoid is in front of the camera, and finite. Otherwise it has no
  // projected ellipse.
  bool IsInFront() const;

  // Writes row `row` of the Jacobians of a residual whose derivative is `derivative`. `jacobians`
  // are as Ceres passes them; null pointers are skipped.
  void WriteRow(int row, const ByObjectInCamera& derivative, double** jacobians) const;

 private:
  Eigen::Matrix3d cam_from_world_;  // rotation
  Eigen::Matrix3d cam_from_object_;
  Eigen::Vector3d object_in_world_;
  Eigen::Vector3d half_axes_;
  Eigen::Vector3d center_;
  Eigen::Matrix3d axes_;
  Eigen::Matrix3d square_;
};

// A cost with the parameters of QuadricInCamera.
class ObjectCost : public ceres::CostFunction {
 protected:
  explicit ObjectCost(size_t residuals);
};

}  // namespace hullslam
