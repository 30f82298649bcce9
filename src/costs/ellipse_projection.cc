// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/ellipse_projection.h"

#include <vector>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

EllipseNumbers ToNumbers(const Ellipse& ellipse) {
  EllipseNumbers numbers;
  numbers << ellipse.center, ellipse.shape(0, 0), ellipse.shape(0, 1), ellipse.shape(1, 1);
  return numbers;
}

Ellipse ToEllipse(const EllipseNumbers& numbers) {
  Ellipse ellipse;
  ellipse.center = numbers.head<2>();
  ellipse.shape << numbers[2], numbers[3], numbers[3], numbers[4];
  return ellipse;
}

EllipseProjection::EllipseProjection(const PinholeCamera& camera, const QuadricInCamera& quadric)
    : camera_(camera), quadric_(quadric) {
  conic_ = quadric.square() - quadric.center() * quadric.center().transpose();
  depth2_ = -conic_(2, 2);
  center_ = -conic_.col(2).head<2>() / depth2_;
  const Eigen::Matrix2d shape =
      conic_.topLeftCorner<2, 2>() / depth2_ + center_ * center_.transpose();
  numbers_ << camera.fx * center_.x() + camera.cx, camera.fy * center_.y() + camera.cy,
      camera.fx * camera.fx * shape(0, 0), camera.fx * camera.fy * shape(0, 1),
      camera.fy * camera.fy * shape(1, 1);
}

Eigen::Matrix2d EllipseProjection::shape() const { return ToEllipse(numbers_).shape; }

// The change of the five numbers for a small symmetric change of conic_. This is the differential
// of the computation in the constructor.
EllipseNumbers EllipseProjection::Change(const Eigen::Matrix3d& change) const {
  const Eigen::Vector2d center = (change(2, 2) * center_ - change.col(2).head<2>()) / depth2_;
  const Eigen::Matrix2d shape =
      (change.topLeftCorner<2, 2>() + conic_.topLeftCorner<2, 2>() * (change(2, 2) / depth2_)) /
          depth2_ +
      center * center_.transpose() + center_ * center.transpose();
  EllipseNumbers numbers;
  numbers << camera_.fx * center.x(), camera_.fy * center.y(),
      camera_.fx * camera_.fx * shape(0, 0), camera_.fx * camera_.fy * shape(0, 1),
      camera_.fy * camera_.fy * shape(1, 1);
  return numbers;
}

void EllipseProjection::Linearize() {
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(k);
    const Eigen::Matrix3d turned = Skew(unit) * quadric_.square();
    derivative_.col(k) = Change(turned + turned.transpose());
    const Eigen::Matrix3d shifted = -unit * quadric_.center().transpose();
    derivative_.col(3 + k) = Change(shifted + shifted.transpose());
    const Eigen::Vector3d axis = quadric_.axes().col(k);
    derivative_.col(6 + k) = Change(2.0 * axis * axis.transpose());
  }
}

EllipseCost::EllipseCost(size_t residuals, const PinholeCamera& camera, double sigma)
    : ObjectCost(residuals), camera_(camera), inverse_sigma_(1.0 / sigma) {}

bool EllipseCost::Evaluate(double const* const* parameters, double* residuals,
                           double** jacobians) const {
  const QuadricInCamera quadric(parameters);
  if (!quadric.IsInFront()) {
    return false;
  }
  EllipseProjection ellipse(camera_, quadric);
  if (!ellipse.HasArea()) {
    return false;
  }
  const auto count = static_cast<size_t>(num_residuals());
  std::vector<ByEllipse> by_ellipse(jacobians != nullptr ? count : 0, ByEllipse::Zero());
  Compute(ellipse.numbers(), {residuals, count}, by_ellipse);
  for (size_t i = 0; i < count; ++i) {
    residuals[i] *= inverse_sigma_;
  }
  if (jacobians != nullptr) {
    ellipse.Linearize();
    for (size_t i = 0; i < count; ++i) {
      ellipse.WriteRow(static_cast<int>(i), inverse_sigma_ * by_ellipse[i], jacobians);
    }
  }
  return true;
}

}  // namespace hullslam
