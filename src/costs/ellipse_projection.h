// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "costs/quadric_in_camera.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/conic.h"

namespace hullslam {

// An ellipse as five numbers: centre m_x, m_y (px) and shape S_xx, S_xy, S_yy (px^2).
using EllipseNumbers = Eigen::Matrix<double, 5, 1>;
// Derivative of a number with respect to these five. S_xy stands for both off-diagonal elements.
using ByEllipse = Eigen::Matrix<double, 1, 5>;

EllipseNumbers ToNumbers(const Ellipse& ellipse);
Ellipse ToEllipse(const EllipseNumbers& numbers);

// The projected ellipse of an ellipsoid in an undistorted image, and its derivative. In the camera
// frame, with B = axes axes^T and the centre t, the dual conic is C* = K (B - t t^T) K^T. Scaled so
// that its last element is -1, it is [[S - m m^T, -m], [-m^T, -1]] (docs/objects.md).
class EllipseProjection {
 public:
  // Keeps references to both arguments. The quadric must be in front of the camera.
  EllipseProjection(const PinholeCamera& camera, const QuadricInCamera& quadric);

  const EllipseNumbers& numbers() const { return numbers_; }
  Eigen::Vector2d center() const { return numbers_.head<2>(); }
  Eigen::Matrix2d shape() const;
  // False if the ellipse is as thin as a line, up to double precision.
  bool HasArea() const { return shape().determinant() > 1e-9; }

  // Linearize() computes the derivative of the five numbers with respect to the object in the
  // camera frame. Before that, derivative() is zero.
  void Linearize();
  const Eigen::Matrix<double, 5, 9>& derivative() const { return derivative_; }
  // Writes row `row` of the Jacobians of a residual that has this derivative with respect to the
  // ellipse.
  void WriteRow(int row, const ByEllipse& by_ellipse, double** jacobians) const {
    quadric_.WriteRow(row, by_ellipse * derivative_, jacobians);
  }

 private:
  EllipseNumbers Change(const Eigen::Matrix3d& change) const;

  const PinholeCamera& camera_;
  const QuadricInCamera& quadric_;
  double depth2_ = 0.0;     // -C*_33 before scaling, m^2
  Eigen::Vector2d center_;  // centre of the ellipse, in the plane at depth 1
  EllipseNumbers numbers_;
  Eigen::Matrix3d conic_;  // B - t t^T, m^2
  Eigen::Matrix<double, 5, 9> derivative_ = Eigen::Matrix<double, 5, 9>::Zero();
};

// A cost of the projected ellipse. Parameters as in QuadricInCamera. Not defined unless the
// quadric is in front of the camera and its projected ellipse has an area.
class EllipseCost : public ObjectCost {
 public:
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const final;

 protected:
  EllipseCost(size_t residuals, const PinholeCamera& camera, double sigma);

 private:
  // Computes the residuals times sigma, and their derivatives unless `by_ellipse` is empty.
  virtual void Compute(const EllipseNumbers& ellipse, std::span<double> residuals,
                       std::span<ByEllipse> by_ellipse) const = 0;

  PinholeCamera camera_;
  double inverse_sigma_;
};

}  // namespace hullslam
