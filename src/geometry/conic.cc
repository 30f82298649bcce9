// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/conic.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Vector2d Mean(std::span<const Eigen::Vector2d> points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) {
    sum += point;
  }
  return sum / static_cast<double>(points.size());
}

// Whether the points lie on a line, or nearly.
bool IsFlat(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& mean) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& point : points) {
    scatter += (point - mean) * (point - mean).transpose();
  }
  const Eigen::Vector2d values =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  return !(values[0] > 1e-8 * values[1]);
}

}  // namespace

double Ellipse::HalfExtent(const Eigen::Vector2d& direction) const {
  return std::sqrt(direction.dot(shape * direction));
}

Eigen::AlignedBox2d Ellipse::Bounds() const {
  const Eigen::Vector2d half = shape.diagonal().cwiseSqrt();
  return {center - half, center + half};
}

double Ellipse::Area() const { return kPi * std::sqrt(shape.determinant()); }

Eigen::Matrix3d Ellipse::DualConic() const {
  Eigen::Matrix3d dual;
  dual << shape - center * center.transpose(), -center, -center.transpose(), -1.0;
  return dual;
}

std::vector<Eigen::Vector2d> Ellipse::Polygon(int vertices) const {
  Check(vertices >= 3, "a polygon has three corners or more");
  const double step = 2.0 * kPi / vertices;
  // The polygon of a unit circle has the area vertices / 2 * sin(step) instead of pi.
  const double scale = std::sqrt(step / std::sin(step));
  const Eigen::Matrix2d root = scale * Eigen::Matrix2d(shape.llt().matrixL());
  std::vector<Eigen::Vector2d> polygon;
  polygon.reserve(static_cast<size_t>(vertices));
  for (int i = 0; i < vertices; ++i) {
    polygon.push_back(center + root * Eigen::Vector2d(std::cos(i * step), std::sin(i * step)));
  }
  return polygon;
}

std::optional<Ellipse> EllipseFromDualConic(const Eigen::Matrix3d& dual_conic) {
  const Eigen::Matrix3d scaled = dual_conic / -dual_conic(2, 2);
  if (!scaled.allFinite()) {
    return std::nullopt;
  }
  Ellipse ellipse;
  ellipse.center = -0.5 * (scaled.col(2) + scaled.row(2).transpose()).head<2>();
  const Eigen::Matrix2d block = scaled.topLeftCorner<2, 2>();
  ellipse.shape = 0.5 * (block + block.transpose()) + ellipse.center * ellipse.center.transpose();
  const double trace = ellipse.shape.trace();
  // About the smaller half axis squared; below this it is rounding noise of the difference above.
  const double smaller = ellipse.shape.determinant() / trace;
  const bool good = trace > 0.0 && smaller > 1e-12 * (trace + ellipse.center.squaredNorm());
  return good ? std::optional(ellipse) : std::nullopt;
}

std::optional<Ellipse> FitEllipse(std::span<const Eigen::Vector2d> contour) {
  if (contour.size() < 5) {
    return std::nullopt;
  }
  const Eigen::Vector2d mean = Mean(contour);
  if (IsFlat(contour, mean)) {
    return std::nullopt;
  }
  std::vector<cv::Point2f> points;
  points.reserve(contour.size());
  for (const Eigen::Vector2d& point : contour) {
    const Eigen::Vector2f moved = (point - mean).cast<float>();
    points.emplace_back(moved.x(), moved.y());
  }
  const cv::RotatedRect box = cv::fitEllipseDirect(points);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(box.angle * kPi / 180.0).toRotationMatrix();
  const Eigen::Vector2d half(0.5 * box.size.width, 0.5 * box.size.height);
  Ellipse ellipse;
  ellipse.center = mean + Eigen::Vector2d(box.center.x, box.center.y);
  ellipse.shape = turn * half.cwiseAbs2().asDiagonal() * turn.transpose();
  const bool good = ellipse.center.allFinite() && ellipse.shape.allFinite() &&
                    half.minCoeff() > 1e-6 * half.maxCoeff();
  return good ? std::optional(ellipse) : std::nullopt;
}

}  // namespace hullslam
