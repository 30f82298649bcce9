// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/conic.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

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

// Standard deviations of the points: first the smaller one, across the main direction, then the
// larger one, along it.
Eigen::Vector2d Spread(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& mean) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& point : points) {
    scatter += (point - mean) * (point - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter, Eigen::EigenvaluesOnly);
  const Eigen::Vector2d variances = solver.eigenvalues() / static_cast<double>(points.size());
  return variances.cwiseMax(0.0).cwiseSqrt();
}

// Fits an ellipse to the points (point - origin) / scale and returns its conic C, p^T C p = 0. The
// direct least-squares fit of Fitzgibbon, Pilu and Fisher (1999), in the numerically stable form of
// Halir and Flusser (1998).
std::optional<Eigen::Matrix3d> DirectLeastSquares(std::span<const Eigen::Vector2d> points,
                                                  const Eigen::Vector2d& origin, double scale) {
  // Sums over (x^2, x y, y^2) and (x, y, 1).
  Eigen::Matrix3d quadratic = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d p = (point - origin) / scale;
    const Eigen::Vector3d second(p.x() * p.x(), p.x() * p.y(), p.y() * p.y());
    const Eigen::Vector3d first = p.homogeneous();
    quadratic += second * second.transpose();
    mixed += second * first.transpose();
    linear += first * first.transpose();
  }
  const Eigen::Matrix3d first_from_second = -linear.inverse() * mixed.transpose();
  const Eigen::Matrix3d reduced = quadratic + mixed * first_from_second;
  if (!reduced.allFinite()) {
    return std::nullopt;
  }
  Eigen::Matrix3d constraint;  // a^T constraint a = 4 a0 a2 - a1^2 > 0: an ellipse
  constraint << 0.0, 0.0, 2.0, 0.0, -1.0, 0.0, 2.0, 0.0, 0.0;
  // `reduced` is singular if the points lie on a conic exactly.
  const Eigen::Matrix3d weight = reduced + 1e-14 * quadratic.trace() * Eigen::Matrix3d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(constraint, weight);
  const Eigen::Vector3d a = solver.eigenvectors().col(2);  // only one of the three is an ellipse
  if (!(solver.eigenvalues()[2] > 0.0 && a.allFinite())) {
    return std::nullopt;
  }
  const Eigen::Vector3d b = first_from_second * a;
  Eigen::Matrix3d conic;
  conic << a[0], 0.5 * a[1], 0.5 * b[0], 0.5 * a[1], a[2], 0.5 * b[1], 0.5 * b[0], 0.5 * b[1], b[2];
  return conic;
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
  Check(vertices >= 3, "a polygon needs at least 3 corners");
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
  // About the square of the smaller half axis. If it is tiny, it is only the rounding error of the
  // sum above.
  const double smaller = ellipse.shape.determinant() / trace;
  const bool good = trace > 0.0 && smaller > 1e-12 * (trace + ellipse.center.squaredNorm());
  return good ? std::optional(ellipse) : std::nullopt;
}

std::optional<Ellipse> FitEllipse(std::span<const Eigen::Vector2d> contour) {
  if (contour.size() < 5) {
    return std::nullopt;
  }
  const Eigen::Vector2d mean = Mean(contour);
  const Eigen::Vector2d spread = Spread(contour, mean);
  const double scale = spread[1];
  if (!(spread[0] > 1e-4 * scale)) {
    return std::nullopt;  // on a line
  }
  const auto conic = DirectLeastSquares(contour, mean, scale);
  if (!conic) {
    return std::nullopt;
  }
  auto ellipse = EllipseFromDualConic(conic->inverse());
  if (ellipse) {
    ellipse->center = mean + scale * ellipse->center;
    ellipse->shape *= scale * scale;
  }
  return ellipse;
}

}  // namespace hullslam
