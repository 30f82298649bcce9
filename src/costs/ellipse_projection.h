// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "costs/quadric_in_camera.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/conic.h"

namespace hullslam {

// An ellipse as five numbers: centre m_x, m_y (px) and shape S_xx, S_xy, S_yy (px^2).
using EllipseNumbers = Eigen::Matrix<double, 5, 1>;
// Derivative of a number by them; S_xy stands for both of its places in the matrix.
using ByEllipse = Eigen::Matrix<double, 1, 5>;

EllipseNumbers ToNumbers(const Ellipse& ellipse);
Ellipse ToEllipse(const EllipseNumbers& numbers);

// The outline of an ellipsoid in an undistorted image and how it changes. In the camera frame, with
// B = axes axes^T and t the centre, the dual conic is C* = K (B - t t^T) K^T; scaled so that its
// last element is -1 it is [[S - m m^T, -m], [-m^T, -1]] (docs/objects.md).
class EllipseProjection {
 public:
  // Refers to both. Only for a quadric in front of the camera.
  EllipseProjection(const PinholeCamera& camera, const QuadricInCamera& quadric);

  const EllipseNumbers& numbers() const { return numbers_; }
  Eigen::Vector2d center() const { return numbers_.head<2>(); }
  Eigen::Matrix2d shape() const;
  // Whether it is more than a line to double precision.
  bool HasArea() const { return shape().determinant() > 1e-9; }

  // Derivative of the numbers by the object in the camera; zero before Linearize.
  void Linearize();
  const Eigen::Matrix<double, 5, 9>& derivative() const { return derivative_; }
  // Row `row` of the Jacobians of a residual with this derivative by the ellipse.
  void WriteRow(int row, const ByEllipse& by_ellipse, double** jacobians) const {
    quadric_.WriteRow(row, by_ellipse * derivative_, jacobians);
  }

 private:
  EllipseNumbers Change(const Eigen::Matrix3d& change) const;

  const PinholeCamera& camera_;
  const QuadricInCamera& quadric_;
  double depth2_ = 0.0;     // -C*_33 before scaling, m^2
  Eigen::Vector2d center_;  // of the ellipse, at depth 1
  EllipseNumbers numbers_;
  Eigen::Matrix3d conic_;  // B - t t^T, m^2
  Eigen::Matrix<double, 5, 9> derivative_ = Eigen::Matrix<double, 5, 9>::Zero();
};

}  // namespace hullslam
